// The same frame of every job side by side; one slider for all.

// a step of 0: jobs differ in the length of a frame
const frameText = number => `frame ${number}` + (data.frames.step > 0 ? `, ${format(number * data.frames.step)} s` : '');

function makeFrames(place) {
  const count = data.frames.numbers.length;
  const figures = data.frames.jobs.map(job => {
    const picture = element('img', {alt: jobName(job.row), width: data.frames.width, height: data.frames.height});
    const ended = element('span', {class: 'ended'}), colors = element('span', {class: 'colors'});
    return {job, picture, ended, colors, box: element('a', {href: '#job-' + rows[job.row].hash, class: 'picture'}, element('figure', {}, picture, element('figcaption', {}, jobName(job.row), ended, colors)))};
  });
  const label = element('output', {}), printed = element('p', {class: 'printed'}), ranges = element('p', {class: 'ranges'}), slider = element('input', {type: 'range', id: 'frame', min: 0, max: count - 1, step: 1, value: count - 1, 'aria-label': 'frame', oninput: show});
  let timer = 0;
  const play = element('button', {onclick: () => {
    if (timer) { clearInterval(timer); timer = 0; play.textContent = 'play'; return; }
    play.textContent = 'stop';
    timer = setInterval(() => { slider.value = (Number(slider.value) + 1) % count; show(); }, 250);
  }}, 'play');
  function show() {
    const k = Number(slider.value);
    label.textContent = printed.textContent = frameText(data.frames.numbers[k]);
    for (const f of figures) {
      const is = f.job.pictures[k] !== '';
      f.picture.src = f.job.pictures[k] || f.job.lastPicture;
      f.picture.dataset.frame = is ? data.frames.numbers[k] : f.job.last;
      f.ended.textContent = is ? '' : ` (${rows[f.job.row].status}: its last is ${frameText(f.job.last)})`;
      f.box.classList.toggle('over', !is);
      f.colors.textContent = f.job.colors[is ? k : count];
    }
    const differ = new Set(figures.map(f => f.colors.textContent).filter(text => text !== '')).size > 1;
    ranges.textContent = differ ? 'The same colour stands for other values from picture to picture: the range of each is below it. A max in the scene (view.stress.max, view.heat.max, ...) gives all of them one range.' : '';
    ranges.hidden = !differ;
  }
  place.append(element('div', {class: 'controls'}, play, slider, label), printed, ranges, element('div', {class: 'sheet'}, ...figures.map(f => f.box)));
  show();
}
