// One job in full, opened by whatever links to #job-HASH.

function openJob() {
  const dialog = document.getElementById('job'), hash = location.hash.startsWith('#job-') ? location.hash.slice(5) : '';
  const i = rows.findIndex(r => r.hash === hash);
  for (const r of document.querySelectorAll('#jobs tr.chosen')) r.classList.remove('chosen');
  if (i < 0) { if (dialog.open) dialog.close(); return; }
  document.getElementById('row-' + hash)?.classList.add('chosen');
  const folder = `jobs/${hash}/`, pictures = data.frames ? data.frames.jobs.find(j => j.row === i) : null;
  const file = (name, text) => element('a', {href: folder + name}, text);
  const line = c => rows[i].cells[c] === '' ? null : element('tr', {}, element('th', {scope: 'row'}, columns[c].label), element('td', {}, (isNumeric(c) && columns[c].kind !== 'varied' ? format(number(i, c), 6) : rows[i].cells[c]) + (columns[c].unit ? ' ' + columns[c].unit : '')));
  dialog.replaceChildren(
      element('button', {class: 'close', onclick: () => dialog.close(), 'aria-label': 'close'}, '✕'),
      element('h2', {}, jobName(i)),
      element('p', {}, `Job ${hash}: ${rows[i].status}.`, rows[i].reason ? ' ' + rows[i].reason : '', rows[i].doubts ? ' In doubt: ' + rows[i].doubts : ''),
      element('p', {class: 'links'}, file('run/', 'folder of the run'), file('run/stats.csv', 'figures by frame'), file('run/run.toml', 'resolved scene'), data.frames ? file('run/frames/', 'all pictures') : null, file('output.txt', 'what it said')),
      element('p', {}, 'Run it again, from the folder of this page: ', element('code', {}, `impinge run ${folder}run/run.toml --out again`)),
      pictures ? element('div', {class: 'strip'}, ...data.frames.numbers.map((n, k) => [n, pictures.pictures[k]]).concat([[pictures.last, pictures.lastPicture]]).map(([n, p]) => p ? element('a', {href: `${folder}run/frames/${String(n).padStart(6, '0')}.png`, title: 'full size'}, element('img', {src: p, alt: frameText(n), loading: 'lazy'}), element('small', {}, frameText(n))) : null)) : null,
      element('table', {class: 'plain'}, element('tbody', {}, ...columns.map((c, k) => ['hash', 'status', 'reason', 'doubts'].includes(c.kind) ? null : line(k)))));
  if (!dialog.open) dialog.showModal();
  dialog.scrollTop = 0;
}

if (document.getElementById('plot')) makePlot(document.getElementById('plot'));
if (document.getElementById('heat')) makeHeatMap(document.getElementById('heat'));
if (document.getElementById('frames')) makeFrames(document.getElementById('frames'));
makeTable(document.getElementById('table'));
const dialog = document.getElementById('job');
dialog.addEventListener('close', () => { if (location.hash.startsWith('#job-')) history.replaceState(null, '', location.pathname + location.search); });
dialog.addEventListener('click', event => { if (event.target === dialog) dialog.close(); });
// a second click on the same job opens it again
document.addEventListener('click', event => { const link = event.target.closest?.('a[href^="#job-"]'); if (link && link.getAttribute('href') === location.hash) openJob(); });
window.addEventListener('hashchange', openJob);
openJob();
