// The state of the page: settings by their names, as texts. It stands in the address after #, and in a command.
const stateNames = [
  'bias.constant', 'bias.slope', 'bias.normal_offset', 'filter.kind', 'filter.size', 'map.resolution', 'map.extent_m',
  'map.format', 'light.azimuth_deg', 'light.elevation_deg'
];

function initialState(data) {
  const state = {};
  for (const name of stateNames) state[name] = data.state[name];
  return state;
}

// A state from "#name=value&name=value"; what is missing is as the page began. Throws Error for a name or a value that is
// no setting of the page.
function stateFrom(fragment, data) {
  const state = initialState(data);
  for (const part of fragment.replace(/^#/, '').split('&')) {
    if (!part) continue;
    const [name, value] = part.split('=').map(decodeURIComponent);
    if (!stateNames.includes(name)) throw new Error(`the address names ${name}, which this page has no control for`);
    state[name] = value;
  }
  checkedState(state);
  return state;
}

const fragmentOf = state => '#' + stateNames.map(n => n + '=' + encodeURIComponent(state[n])).join('&');

// The numbers of a state. Ranges are those of technique/settings.cpp. Throws Error.
function checkedState(state) {
  const number = (name, low, high, whole) => {
    const text = String(state[name]).trim(), value = Number(text);
    if (text === '' || !(value >= low && value <= high) || (whole && value !== Math.round(value)))
      throw new Error(`${name} = ${text}: it takes ${whole ? 'a whole number' : 'a number'} from ${low} to ${high}`);
    return value;
  };
  const orAuto = (name, low, high) => state[name] === 'auto' ? null : number(name, low, high);
  const oneOf = (name, values) => {
    if (!values.includes(state[name])) throw new Error(`${name} = ${state[name]}: it takes ${values.join(', ')}`);
    return state[name];
  };
  const size = number('filter.size', 1, 31, true), kind = oneOf('filter.kind', ['none', 'box']);
  if (kind === 'box' && size % 2 === 0) throw new Error(`filter.size = ${size} is even; it takes an odd number`);
  return {
    resolution: number('map.resolution', 1, 8192, true), extent: orAuto('map.extent_m', 1e-6, 1e9),
    format: oneOf('map.format', ['16', '24', '32f']), azimuth: orAuto('light.azimuth_deg', -360, 360),
    elevation: orAuto('light.elevation_deg', -90, 90), filterSize: kind === 'box' ? size : 1,
    bias: {
      constant: number('bias.constant', 0, 1e6), slope: number('bias.slope', 0, 1e6),
      normal_offset: number('bias.normal_offset', 0, 1e6)
    }
  };
}

// A command that measures the same point: every setting that is not at its default.
function commandOf(state, data) {
  const settings = Object.assign({}, data.settings);
  for (const name of stateNames)
    if (state[name] !== data.defaults[name] || name in data.settings) settings[name] = state[name];
  const entries = Object.entries(settings).sort(([a], [b]) => (b === 'scene.name') - (a === 'scene.name'));
  const words = entries.map(([name, value]) => {
    const word = `${name}=${value}`;
    return '--set ' + (/^[\w.,:+\/=@%-]+$/.test(word) ? word : "'" + word.replace(/'/g, "'\\''") + "'");
  });
  return ['noonmark render', ...words].join(' ');
}
