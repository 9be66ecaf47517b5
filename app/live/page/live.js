// The page itself: controls, the state in the address, and what is said about the picture.
const data = JSON.parse(document.getElementById('live-data').textContent);
const element = id => document.getElementById(id);

// Sliders. to: from the slider's position, 0 ... 1, to a value; from: its inverse.
const digits = (x, count = 3) => String(Number(x.toPrecision(count)));
const logarithmic = (least, most) => ({  // position 0 is the value 0
  to: p => p <= 0 ? 0 : least * Math.pow(most / least, (p - 0.02) / 0.98),
  from: v => v <= 0 ? 0 : 0.02 + 0.98 * clamped(Math.log(v / least) / Math.log(most / least), 0, 1)
});
const linear = (low, high) => ({to: p => low + p * (high - low), from: v => clamped((v - low) / (high - low), 0, 1)});
const unitOfBias = ['depth', 'm', 'texels'][data.bias.unit], mostBias = [0.1, 1, 20][data.bias.unit];
const leastBias = [1e-6, 1e-4, 0.01][data.bias.unit];
const controls = [
  {name: 'bias.constant', label: `Constant bias, ${unitOfBias}`, ...logarithmic(leastBias, mostBias)},
  {name: 'bias.slope', label: `Slope bias, ${unitOfBias}`, help: 'times 1 − N·L', ...logarithmic(leastBias, mostBias)},
  {name: 'bias.normal_offset', label: 'Normal offset, texels', ...linear(0, 5), step: 0.05},
  {name: 'map.resolution', label: 'Resolution, texels', to: p => Math.round(Math.pow(2, 4 + 8 * p)), from: v => (Math.log2(v) - 4) / 8},
  {name: 'map.extent_m', label: 'Extent of the map, m', automatic: run => run.frame.extent},
  {name: 'light.azimuth_deg', label: 'Azimuth of the sun, °', ...linear(-180, 180), step: 0.5, automatic: run => sunOf(run).azimuth},
  {name: 'light.elevation_deg', label: 'Elevation of the sun, °', ...linear(1, 90), step: 0.5, automatic: run => sunOf(run).elevation},
  {name: 'filter', label: 'Filter', choices: ['none', ...[3, 5, 7, 9].map(n => `box ${n} × ${n}`)]},
  {name: 'map.format', label: 'Depth format, bits', choices: ['16', '24', '32f']}
];
const sunOf = run => placeOfSun(minus(run.light.position, run.light.target));

let meter, state = initialState(data), run = null, kind = 'causes', stretched = true, colours = {}, planned = false, addressTimer = 0;

// In one sentence: the largest cause, and what helps against it.
const advice = {
  acne: ['Acne', 'wrongly dark, because the lookup meets its own surface: raise the bias or take more texels'],
  peter_panning: ['Peter Panning', 'wrongly light, because the bias is larger than the gap to the occluder: lower the bias'],
  aliasing: ['Aliasing', 'wrong because a texel is answered by its centre: take more texels or a smaller extent'],
  coverage: ['Coverage', 'wrong because the map does not hold their place: make its extent larger'],
  filter: ['The filter', 'blurred by design: a smaller filter is nearer to the hard edge'],
  displacement: ['Displacement', 'looked up elsewhere by the normal offset: make it smaller'],
  precision: ['Precision', 'wrong because stored depths are rounded: take a deeper format or raise the bias']
};
const percent = share => (100 * share).toFixed(2) + ' %';
// many_ambiguous() in compare/judge/undecided.h.
function areMany(share, receivers) {
  const usual = data.much_ambiguous * receivers;
  return share * receivers > usual + 3 * Math.sqrt(usual);
}
// Places of float are then as coarse as what the page would draw, so none of its numbers is the program's.
const isRefused = m => m.facing > 0 && areMany(m.ambiguous, m.facing);
function sentence(m) {
  if (!m.facing) return 'No receiver in the picture faces the light.';
  if (isRefused(m))
    return `This page does not show this scene, because in float rounding decides the truth of ${percent(m.ambiguous)} of the receivers: ` +
        'it is too far from the origin for its size, or shapes overlap. The command below measures it.';
  const [cause] = Object.keys(advice).sort((a, b) => m[b] - m[a]);
  if (m.error === 0) return 'No receiver is wrong.';
  const [name, what] = advice[cause];
  return `${percent(m.error)} of the receivers are wrong. ${name}, ${percent(m[cause])}: ${what}.`;
}

function setPressed(selector, matches) {
  document.querySelectorAll(selector).forEach(b => b.setAttribute('aria-pressed', String(matches(b))));
}

function drawPictures() {
  drawFrame(element('frame'), kind, run, meter.receivers, colours);
  drawMap(element('map'), meter.mapPicture(160), stretched);
  element('stretch').textContent = stretched ? 'depth, stretched' : 'depth, as stored';
  setPressed('.tabs button', b => b.dataset.kind === kind);
  setPressed('#stretch', () => stretched);
}

function fillLegend(m) {
  const rows = data.colours.filter(c => c.name in m && !['aliasing', 'coverage', 'lit'].includes(c.name));
  element('legend').replaceChildren(...rows.map(c => {
    const row = document.createElement('div'), key = document.createElement('i'), label = document.createElement('span'),
          term = document.createElement('dt'), value = document.createElement('dd');
    key.style.background = `var(--c-${c.name})`;
    label.textContent = c.label;
    value.textContent = percent(m[c.name]);
    row.className = m[c.name] ? '' : 'none';
    term.append(key, label);
    row.append(term, value);
    return row;
  }));
  element('numbers').textContent = `${m.facing} of ${data.width} × ${data.height} pixels face the light, ${percent(m.lit)} of them are lit. ` +
      `A texel is ${digits(run.frame.texel)} m wide; near and far are ${digits(run.frame.near, 4)} m and ${digits(run.frame.far, 4)} m.` +
      data.notes.map(n => ` ${n}.`).join('');
}

function fillControls() {
  for (const c of controls) {
    const {text, slider} = c;
    if (c.choices) {
      const value = c.name === 'filter' ? (state['filter.kind'] === 'none' ? 'none' : `box ${state['filter.size']} × ${state['filter.size']}`) : state[c.name];
      if (![...text.options].some(o => o.value === value)) text.add(new Option(value, value));
      text.value = value;
      continue;
    }
    const auto = state[c.name] === 'auto', value = auto ? c.automatic(run) : Number(state[c.name]);
    if (document.activeElement !== text) text.value = auto ? 'auto' : state[c.name];
    if (document.activeElement !== slider || !c.moving) slider.value = c.from(value);
    c.note.textContent = auto ? `auto: ${digits(value, 4)}` : c.help || '';
  }
  element('command').textContent = commandOf(state, data);
}

function show() {
  planned = false;
  try {
    run = meter.measure(state);
    element('says').className = '';
    document.querySelector('.left').classList.toggle('refused', isRefused(run.metrics));
    element('says').textContent = sentence(run.metrics);
    fillLegend(run.metrics);
    drawPictures();
    fillControls();
    // Browsers refuse a new address for each step of a slider.
    clearTimeout(addressTimer);
    addressTimer = setTimeout(() => history.replaceState(null, '', fragmentOf(state)), 200);
  } catch (error) {
    element('says').className = 'fails';
    element('says').textContent = error.message;
  }
}
// At most one picture for each frame of the screen.
function showSoon() {
  if (!planned) requestAnimationFrame(show);
  planned = true;
}

function makeControls() {
  const extent = run.frame.extent;
  Object.assign(controls.find(c => c.name === 'map.extent_m'), logarithmic(extent / 16, extent * 4));
  for (const c of controls) {
    const box = document.createElement('div'), label = document.createElement('label');
    box.className = 'control';
    label.textContent = c.label;
    label.htmlFor = 'value-' + c.name;
    if (c.choices) {
      c.text = document.createElement('select');
      for (const value of c.choices) c.text.add(new Option(value, value));
      c.text.onchange = () => {
        if (c.name === 'filter') {
          const [kindName, size] = c.text.value.split(' ');
          Object.assign(state, {'filter.kind': kindName}, size && {'filter.size': size});
        } else
          state[c.name] = c.text.value;
        showSoon();
      };
    } else {
      c.text = document.createElement('input');
      c.text.type = 'text';
      c.text.onchange = () => {
        state[c.name] = c.text.value.trim();
        c.text.blur();
        showSoon();
      };
      c.slider = document.createElement('input');
      Object.assign(c.slider, {type: 'range', min: 0, max: 1, step: 0.002});
      c.slider.setAttribute('aria-label', c.label);
      c.slider.oninput = () => {
        const value = c.to(Number(c.slider.value));
        state[c.name] = c.step ? digits(c.step * Math.round(value / c.step), 6) : digits(value, 4);
        c.moving = true;
        showSoon();
      };
      c.slider.onchange = () => {
        c.moving = false;
      };
    }
    c.text.id = 'value-' + c.name;
    c.note = document.createElement('small');
    box.append(label, c.text, ...(c.slider ? [c.slider] : []), c.note);
    element('controls').append(box);
  }
}

function useFragment() {
  try {
    state = stateFrom(location.hash, data);
    show();
  } catch (error) {
    state = initialState(data);
    show();
    element('says').className = 'fails';
    element('says').textContent = `${error.message}; the page shows the state as it began`;
  }
}

async function start() {
  colours = causeColours(data.colours.map(c => c.name));
  Object.assign(element('frame'), {width: data.width, height: data.height});
  meter = new Meter(data, await unpackedMesh(data), noonmarkLive.shaders);
  run = meter.measure(state);
  makeControls();
  useFragment();
  addEventListener('hashchange', useFragment);
  document.querySelectorAll('.tabs button').forEach(b => b.onclick = () => {
    kind = b.dataset.kind;
    drawPictures();
  });
  element('stretch').onclick = () => {
    stretched = !stretched;
    drawPictures();
  };
  element('reset').onclick = () => {
    state = initialState(data);
    show();
  };
  element('copy').onclick = async () => {
    await navigator.clipboard.writeText(commandOf(state, data));
    element('copy').textContent = 'Copied';
  };
  element('controls').onsubmit = event => event.preventDefault();
}
noonmarkLive.measure = changes => meter.measure(Object.assign(initialState(data), changes)).metrics;
noonmarkLive.start = start;
