// The jobs as a table: a click on a head sorts, a click on a job opens it.

function makeTable(place) {
  const rank = i => ({varied: 0, status: 1, time: 2, spread: 3, error: 4})[columns[i].kind] ?? 5;
  const always = columns.map((c, i) => i).filter(i => columns[i].main && !['reason', 'doubts'].includes(columns[i].kind)).sort((a, b) => rank(a) - rank(b) || a - b), every = columns.map((c, i) => i).filter(i => !['hash', 'reason', 'doubts'].includes(columns[i].kind));
  const state = {all: false, only: false, sort: -1, up: true};
  const x = columnAt(data.plot.x), y = columnAt(data.plot.y);
  const judged = rows.map((r, i) => i).filter(i => rows[i].status === 'done' && !rows[i].doubts && isFinite(number(i, x)) && isFinite(number(i, y)));
  const reference = columnAt('reference'), isOwn = i => reference >= 0 && rows[i].cells[reference] === rows[i].hash;
  const front = data.reference.length ? best(x, y, judged.filter(i => !isOwn(i))) : [];
  const smallest = {};
  for (const c of every) {
    const values = judged.filter(i => columns[c].kind !== 'error' || !isOwn(i)).map(i => number(i, c)).filter(isFinite);
    if (['time', 'error'].includes(columns[c].kind) && values.length > 1 && Math.min(...values) < Math.max(...values)) smallest[c] = Math.min(...values);
  }
  const table = element('table', {id: 'jobs'});
  const box = (text, key) => { const b = element('input', {type: 'checkbox', onchange: () => { state[key] = b.checked; draw(); }}); return element('label', {}, b, ' ' + text); };
  place.append(element('div', {class: 'controls'}, box('all columns', 'all'), front.length ? box('only the best', 'only') : null), element('div', {class: 'wide'}, table));

  function compare(a, b, c) {
    const s = rows[a].cells[c], t = rows[b].cells[c];
    if (s === '' || t === '') return s === t ? 0 : s === '' ? 1 : -1;  // what has no figure stands last either way
    return (isNumeric(c) ? Number(s) - Number(t) : s.localeCompare(t)) * (state.up ? 1 : -1);
  }
  function draw() {
    const shown = state.all ? every : always;
    let order = rows.map((r, i) => i).filter(i => !state.only || front.includes(i));
    if (state.sort >= 0) order.sort((a, b) => compare(a, b, state.sort) || a - b);
    const head = c => element('th', {scope: 'col', title: columns[c].doc || null, class: isNumeric(c) ? 'number' : '', 'aria-sort': state.sort === c ? (state.up ? 'ascending' : 'descending') : 'none'},
        element('button', {onclick: () => { state.up = state.sort === c ? !state.up : true; state.sort = c; draw(); }}, ...breakable(columns[c].label), columns[c].unit ? element('small', {}, ' ' + columns[c].unit) : null,
                element('span', {class: 'arrow'}, state.sort === c ? (state.up ? ' ▲' : ' ▼') : '')));
    const cell = (i, c) => {
      const text = rows[i].cells[c], figure = isNumeric(c) && columns[c].kind !== 'varied';
      if (columns[c].kind === 'error' && isOwn(i)) return element('td', {class: 'number', title: 'this job is its own reference'}, '–');
      return element('td', {class: [isNumeric(c) ? 'number' : '', figure && number(i, c) === smallest[c] ? 'smallest' : ''].join(' ').trim() || null, title: figure && text ? text : null},
                     figure ? format(number(i, c)) : columns[c].kind === 'reference' ? text.slice(0, 8) : text);
    };
    // the reason on a line of its own, in sight however wide the table is
    const why = (i, width) => [[rows[i].reason, rows[i].status], [rows[i].doubts && 'in doubt: ' + rows[i].doubts, 'doubted']].filter(([text]) => text)
        .map(([text, kind]) => element('tr', {class: 'why ' + kind}, element('td', {colspan: width}, element('div', {}, text))));
    table.replaceChildren(element('thead', {}, element('tr', {}, element('th', {scope: 'col'}, 'job'), ...shown.map(head))),
        element('tbody', {}, ...order.flatMap(i => [element('tr', {id: 'row-' + rows[i].hash, class: rows[i].status + (rows[i].doubts ? ' doubted' : '') + (front.includes(i) ? ' best' : '')},
            element('th', {scope: 'row'}, element('a', {href: '#job-' + rows[i].hash}, rows[i].hash.slice(0, 8)), front.includes(i) ? element('span', {class: 'star', title: 'no other job is both faster and more exact'}, ' ◆') : isOwn(i) ? element('small', {title: 'this job is its own reference'}, ' ref') : null),
            ...shown.map(c => cell(i, c))), ...why(i, shown.length + 1)])));
  }
  draw();
}
