// Error against time, or any column against any other: a point a job, each a link to it.

const Marks = [
  (x, y) => shape('circle', {cx: x, cy: y, r: 5}),
  (x, y) => shape('rect', {x: x - 4.6, y: y - 4.6, width: 9.2, height: 9.2}),
  (x, y) => shape('path', {d: `M${x} ${y - 6.2}l6 10.4h-12z`}),
  (x, y) => shape('path', {d: `M${x} ${y - 6.4}l6.4 6.4l-6.4 6.4l-6.4-6.4z`}),  // no cross: that is doubt
];
const markOf = (i, x, y) => fill(Marks[i % Marks.length](x, y), {fill: Colors[i % Colors.length], stroke: '#fff', 'stroke-width': 1}, []);

class Axis {
  constructor(values, log, from, to) {
    Object.assign(this, {log, from, to});
    let low = Math.min(...values), high = Math.max(...values);
    if (log) {
      low = Math.log10(low), high = Math.log10(high);
      const room = Math.max(0.06 * (high - low), 0.08);
      low -= room, high += room;
      if (high - low < 0.7) { const middle = 0.5 * (low + high); low = middle - 0.35, high = middle + 0.35; }
    } else {
      const room = high > low ? 0.06 * (high - low) : Math.abs(high) * 0.1 || 1;
      low = low >= 0 && low - room < 0 ? 0 : low - room, high += room;
    }
    Object.assign(this, {low, high});
  }
  at(v) { return this.from + ((this.log ? Math.log10(v) : v) - this.low) / (this.high - this.low) * (this.to - this.from); }
  ticks(most) {
    const list = [];
    if (this.log) {
      const decades = this.high - this.low, every = Math.max(1, Math.ceil(decades / most));
      const digits = decades < 1.2 ? [1, 2, 3, 5, 7] : decades < 2.6 ? [1, 2, 5] : [1];
      for (let d = Math.floor(this.low); d <= this.high; ++d)
        for (const m of digits) {
          const l = d + Math.log10(m);
          if (l >= this.low && l <= this.high && (m !== 1 || d % every === 0)) list.push([m * Math.pow(10, d), digits.length === 1 || decades > 6 ? power(d) : format(m * Math.pow(10, d), 1)]);
        }
      return list;
    }
    const raw = (this.high - this.low) / most, unit = Math.pow(10, Math.floor(Math.log10(raw)));
    const step = [1, 2, 5, 10].map(m => m * unit).find(s => s >= raw);
    for (let k = Math.ceil(this.low / step); k * step <= this.high * (1 + 1e-12); ++k) list.push([k * step, format(k * step, 4)]);
    return list;
  }
}
const power = d => d >= -3 && d <= 3 ? format(Math.pow(10, d)) : '1e' + d;

function makePlot(place) {
  const usable = columns.map((c, i) => i).filter(i => isNumeric(i) && columns[i].kind !== 'reference' && rows.some((r, k) => isFinite(number(k, i))));
  const state = {x: columnAt(data.plot.x), y: columnAt(data.plot.y), group: 'auto', hidden: new Set()};
  if (state.x < 0) state.x = usable[0];
  if (state.y < 0) state.y = usable[0];
  const options = usable.map(i => [i, heading(i)]);
  const logs = {};
  const joined = varied.filter(c => columns[c].joined);
  const drawing = element('div', {class: 'drawing'}), legend = element('div', {class: 'legend'}), note = element('p', {class: 'note'});
  const logBox = key => {
    const box = element('input', {type: 'checkbox', onchange: () => { logs[key] = box.checked; draw(); }});
    return {box, label: element('label', {}, box, ' logarithmic')};
  };
  const logX = logBox('x'), logY = logBox('y');
  const choose = key => value => { state[key] = Number(value); delete logs[key]; draw(); };
  const groups = [['auto', joined.length ? 'all but ' + joined.map(c => columns[c].name).join(', ') : 'every job'], ['none', 'nothing'], ...varied.filter(c => columns[c].distinct > 1).map(c => [c, columns[c].name])];
  place.append(
      element('div', {class: 'controls'}, chooser('across', options, state.x, choose('x')), logX.label, chooser('up', options, state.y, choose('y')), logY.label,
              chooser('a colour for', groups, state.group, value => { state.group = value; state.hidden.clear(); draw(); })),
      legend, drawing, note);

  // jobs that differ only in what is joined belong to one line
  const keyColumns = () => state.group === 'none' ? [] : state.group !== 'auto' ? [Number(state.group)] : varied.filter(c => !joined.includes(c));
  function nameOf(row) {
    const keys = keyColumns();
    return keys.length === 0 ? 'all jobs' : jobName(row, varied.filter(c => !keys.includes(c)));
  }

  function draw() {
    const finite = rows.map((r, i) => i).filter(i => isFinite(number(i, state.x)) && isFinite(number(i, state.y)));
    const wantsLog = column => {
      const values = finite.map(i => number(i, column)).filter(v => v !== 0);
      return values.length > 0 && values.every(v => v > 0) && (columns[column].kind === 'time' || columns[column].kind === 'error' || Math.max(...values) / Math.min(...values) > 20);
    };
    logX.box.checked = logs.x ?? wantsLog(state.x), logY.box.checked = logs.y ?? wantsLog(state.y);
    const drawable = finite.filter(i => (!logX.box.checked || number(i, state.x) > 0) && (!logY.box.checked || number(i, state.y) > 0));
    const names = [];
    for (const i of drawable) if (!names.includes(nameOf(i))) names.push(nameOf(i));
    legend.replaceChildren(...names.map((name, k) => element('button', {class: state.hidden.has(name) ? 'off' : '', title: 'show or hide', onclick: () => {
      state.hidden.has(name) ? state.hidden.delete(name) : state.hidden.add(name);
      draw();
    }}, shape('svg', {viewBox: '0 0 16 16', width: 16, height: 16}, markOf(k, 8, 8)), ' ' + name)));
    const shown = drawable.filter(i => !state.hidden.has(nameOf(i)));
    const zero = finite.length - drawable.length, missing = rows.length - finite.length;
    note.textContent = [zero ? `${zero} not drawn: 0 has no place on a logarithmic axis${columns[state.y].kind === 'error' ? ' (a job that is its own reference has error 0)' : ''}.` : '',
                        missing ? `${missing} not drawn: no figure (see their reasons in the table).` : ''].join(' ');
    drawing.replaceChildren(shown.length ? picture(shown, names) : element('p', {class: 'note'}, 'Nothing to draw.'));
  }

  function picture(shown, names) {
    const width = 760, height = 470, left = 74, right = 14, top = 30, bottom = 52;
    const x = new Axis(shown.map(i => number(i, state.x)), logX.box.checked, left, width - right), y = new Axis(shown.map(i => number(i, state.y)), logY.box.checked, height - bottom, top);
    const svg = shape('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `${heading(state.y)} against ${heading(state.x)}`});
    for (const [v, t] of x.ticks(8)) svg.append(shape('line', {x1: x.at(v), x2: x.at(v), y1: top, y2: height - bottom, class: 'grid'}), shape('text', {x: x.at(v), y: height - bottom + 17, class: 'middle'}, t));
    for (const [v, t] of y.ticks(9)) svg.append(shape('line', {y1: y.at(v), y2: y.at(v), x1: left, x2: width - right, class: 'grid'}), shape('text', {x: left - 7, y: y.at(v) + 4, class: 'end'}, t));
    svg.append(shape('rect', {x: left, y: top, width: width - left - right, height: height - top - bottom, class: 'frame'}));
    svg.append(shape('text', {x: (left + width - right) / 2, y: height - 10, class: 'middle title'}, heading(state.x)), shape('text', {x: 4, y: 16, class: 'title'}, heading(state.y)));
    const front = best(state.x, state.y, shown).sort((a, b) => number(a, state.x) - number(b, state.x));
    let steps = '';
    front.forEach((r, k) => { steps += k === 0 ? `M${x.at(number(r, state.x))} ${y.at(number(r, state.y))}` : `H${x.at(number(r, state.x))}V${y.at(number(r, state.y))}`; });
    svg.append(shape('path', {d: steps, class: 'front'}));
    names.forEach((name, k) => {
      const line = shown.filter(i => nameOf(i) === name);
      if (keyColumns().length > 0 && line.length > 1 && state.group === 'auto' && data.reference.length > 0)
        svg.append(shape('polyline', {points: line.map(i => `${x.at(number(i, state.x))},${y.at(number(i, state.y))}`).join(' '), fill: 'none', stroke: Colors[k % Colors.length], 'stroke-width': 1.4}));
    });
    const noise = columnAt('spread_' + columns[state.x].name);
    for (const i of shown) {
      const k = names.indexOf(nameOf(i)), px = x.at(number(i, state.x)), py = y.at(number(i, state.y));
      const point = shape('a', {href: '#job-' + rows[i].hash, class: 'point', 'data-job': rows[i].hash});
      if (noise >= 0 && number(i, noise) > 0) {
        const half = number(i, noise) / 2, v = number(i, state.x);
        point.append(shape('line', {x1: x.at(Math.max(v - half, v * 0.05)), x2: x.at(v + half), y1: py, y2: py, stroke: Colors[k % Colors.length], 'stroke-width': 1.4}));
      }
      if (front.includes(i)) point.append(shape('circle', {cx: px, cy: py, r: 9.5, class: 'ring'}));
      point.append(shape('circle', {cx: px, cy: py, r: 11, fill: 'transparent'}), markOf(k, px, py), rows[i].doubts ? shape('path', {d: `M${px - 7} ${py - 7}L${px + 7} ${py + 7}M${px - 7} ${py + 7}L${px + 7} ${py - 7}`, class: 'doubt'}) : '', shape('title', {}, `${jobName(i)}\n${rows[i].doubts ? 'in doubt: ' + rows[i].doubts + '\n' : ''}${heading(state.x)}: ${format(number(i, state.x))}\n${heading(state.y)}: ${format(number(i, state.y))}`));
      svg.append(point);
    }
    return svg;
  }
  draw();
}
