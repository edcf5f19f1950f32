// What all parts of the page share: the data, numbers as text, elements.
'use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const columns = data.columns, rows = data.rows;
const columnAt = name => columns.findIndex(c => c.name === name);
const number = (row, column) => { const t = rows[row].cells[column]; return t === '' ? NaN : Number(t); };
const isNumeric = column => columns[column].numeric;
const heading = column => columns[column].label + (columns[column].unit ? ' (' + columns[column].unit + ')' : '');
const varied = columns.map((c, i) => c.kind === 'varied' ? i : -1).filter(i => i >= 0);
// a long name may break after its points and underscores
const breakable = text => text.split(/(?<=[._])/).flatMap((part, i) => i ? [document.createElement('wbr'), part] : [part]);
const shortPath = path => path.slice(path.lastIndexOf('.') + 1);
const Colors = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#56b4e9', '#e69f00', '#000000'];  // after Okabe & Ito, as in work_precision.png

function format(x, digits = 3) {
  if (!isFinite(x)) return '';
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (Number.isInteger(x) && size < 1e6) return String(x);
  if (size >= 1e5 || size < 1e-3) return x.toExponential(digits - 1).replace('e+', 'e');
  return String(Number(x.toPrecision(digits)));
}

function element(tag, attributes = {}, ...children) {
  const e = document.createElement(tag);
  return fill(e, attributes, children);
}
function shape(tag, attributes = {}, ...children) {
  const e = document.createElementNS('http:/' + '/www.w3.org/2000/svg', tag);
  return fill(e, attributes, children);
}
function fill(e, attributes, children) {
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith('on')) e.addEventListener(key.slice(2), value);
    else e.setAttribute(key, value);
  }
  e.append(...children.filter(c => c !== null && c !== undefined));
  return e;
}

// a label with a choice in it; options are [value, text]
function chooser(label, options, value, changed) {
  const select = element('select', {onchange: () => changed(select.value)}, ...options.map(([v, t]) => element('option', {value: v, selected: String(v) === String(value) ? '' : null}, t)));
  return element('label', {}, label + ' ', select);
}

// what a job is called in captions: the values that were varied
function jobName(row, without = []) {
  const parts = varied.filter(c => !without.includes(c) && columns[c].distinct > 1);
  const text = parts.map(c => isNumeric(c) || /^(true|false)$/.test(rows[row].cells[c]) ? shortPath(columns[c].name) + ' ' + rows[row].cells[c] : rows[row].cells[c]).join(', ');
  return text || (varied.length > without.length ? rows[row].hash.slice(0, 8) : 'all jobs');
}

// rows that nothing beats: no other is at most as large in both columns and smaller in one
function best(x, y, among) {
  among = among.filter(r => !rows[r].doubts);  // an answer in doubt neither is best nor beats another
  return among.filter(r => !among.some(o => number(o, x) <= number(r, x) && number(o, y) <= number(r, y) && (number(o, x) < number(r, x) || number(o, y) < number(r, y))));
}
