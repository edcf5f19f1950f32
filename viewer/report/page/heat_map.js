// One measure over two varied parameters; the others are held at a value each.

function heatColor(t) {
  const list = data.heat, at = Math.min(Math.max(t, 0), 1) * (list.length - 1), k = Math.min(Math.floor(at), list.length - 2), part = at - k;
  return list[k].map((c, i) => Math.round(c + (list[k + 1][i] - c) * part));
}
const paint = c => `rgb(${c.join(',')})`;
const inkOn = c => 0.2126 * Math.pow(c[0] / 255, 2.2) + 0.7152 * Math.pow(c[1] / 255, 2.2) + 0.0722 * Math.pow(c[2] / 255, 2.2) > 0.2 ? '#000' : '#fff';

function makeHeatMap(place) {
  const axes = varied.filter(c => columns[c].distinct > 1);
  const measures = columns.map((c, i) => i).filter(i => isNumeric(i) && !['varied', 'reference'].includes(columns[i].kind) && rows.some((r, k) => isFinite(number(k, i))));
  const state = {row: axes[0], column: axes[1], measure: columnAt(data.plot.measure), held: {}};
  if (state.measure < 0) state.measure = measures[0];
  const valuesOf = c => [...new Set(rows.map(r => r.cells[c]))];
  const shownIn = element('div'), controls = element('div', {class: 'controls'});
  place.append(controls, shownIn);

  function draw() {
    const others = axes.filter(c => c !== state.row && c !== state.column);
    for (const c of others) if (!(c in state.held)) state.held[c] = valuesOf(c)[0];
    const swap = (key, other) => value => { if (Number(value) === state[other]) state[other] = state[key]; state[key] = Number(value); draw(); };
    const names = axes.map(c => [c, columns[c].name]);
    controls.replaceChildren(chooser('down', names, state.row, swap('row', 'column')), chooser('across', names, state.column, swap('column', 'row')),
                             chooser('colour', measures.map(i => [i, heading(i)]), state.measure, v => { state.measure = Number(v); draw(); }),
                             ...others.map(c => chooser(columns[c].name + ' =', valuesOf(c).map(v => [v, v]), state.held[c], v => { state.held[c] = v; draw(); })));
    const shown = rows.map((r, i) => i).filter(i => others.every(c => rows[i].cells[c] === state.held[c]));
    const figures = shown.map(i => number(i, state.measure)).filter(isFinite), positive = figures.filter(v => v > 0);
    const log = positive.length > 1 && figures.every(v => v >= 0) && Math.max(...positive) / Math.min(...positive) > 20;
    const scale = log ? Math.log10 : v => v, low = scale(log ? Math.min(...positive) : Math.min(...figures)), high = scale(Math.max(...figures));
    const share = v => high > low ? (v <= 0 && log ? 0 : (scale(v) - low) / (high - low)) : 0.5;
    const across = valuesOf(state.column), down = valuesOf(state.row);
    const cell = (a, b) => {
      const i = shown.find(k => rows[k].cells[state.row] === a && rows[k].cells[state.column] === b);
      if (i === undefined) return element('td', {class: 'none'}, 'not run');
      const v = number(i, state.measure), link = t => element('a', {href: '#job-' + rows[i].hash, title: jobName(i) + (rows[i].reason ? '\n' + rows[i].reason : '') + (rows[i].doubts ? '\nin doubt: ' + rows[i].doubts : '')}, t);
      if (!isFinite(v)) return element('td', {class: 'none'}, link(rows[i].status === 'done' ? 'no figure' : rows[i].status));
      const c = heatColor(share(v));
      return element('td', {class: 'cell', style: `background:${paint(c)};color:${inkOn(c)}`, 'data-job': rows[i].hash}, link(format(v) + (rows[i].status === 'done' ? '' : ' (' + rows[i].status + ')')), rows[i].doubts ? element('b', {class: 'crossed', title: 'in doubt'}, '×') : '');
    };
    const table = element('table', {class: 'heat'},
        element('thead', {}, element('tr', {}, element('td'), element('th', {colspan: across.length, class: 'over'}, columns[state.column].name)),
                element('tr', {}, element('th', {class: 'over'}, columns[state.row].name), ...across.map(b => element('th', {scope: 'col'}, b)))),
        element('tbody', {}, ...down.map(a => element('tr', {}, element('th', {scope: 'row'}, a), ...across.map(b => cell(a, b))))));
    const stops = Array.from({length: 17}, (_, k) => paint(heatColor(k / 16))).join(',');
    const bar = figures.length === 0 ? null : element('div', {class: 'bar'}, element('span', {}, format(log ? Math.pow(10, low) : low)), element('i', {style: `background:linear-gradient(to right,${stops})`}),
                                                      element('span', {}, format(log ? Math.pow(10, high) : high)), element('span', {class: 'name'}, heading(state.measure) + (log ? ', logarithmic' : '')));
    const held = others.map(c => `${columns[c].name} = ${state.held[c]}`).join(', ');
    shownIn.replaceChildren(element('div', {class: 'wide'}, table), bar ?? '', element('p', {class: 'printed'}, held));
  }
  draw();
}
