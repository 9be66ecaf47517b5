// The pictures: colours of pixels, and the map in the corner. The colours and the shading are those of the report's live
// picture (compare/report/page/live.js).
const grey = linear => {
  const v = 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * Math.pow(linear, 1 / 2.4) - 0.055);
  return [v, v, v];
};

function causeColours(names) {
  const style = getComputedStyle(document.documentElement), colours = {};
  for (const name of names) {
    const text = style.getPropertyValue('--c-' + name).trim();
    colours[name] = [1, 3, 5].map(k => parseInt(text.slice(k, k + 2), 16));
  }
  return colours;
}

// The cause that names pixel i, as pixel_cause() of compare/ladder/ladder.cpp; '' where it is right.
function causeOf({taps, rungs, causes, others}, i) {
  const at = 4 * i, truth = rungs[at] & 2 ? taps : 0;
  if (rungs[at + 3] === truth) return '';
  if (taps === 1 && rungs[at + 2] === truth) return 'precision';
  const steps = [
    ['filter', Math.abs(rungs[at + 1] - truth)], ['displacement', Math.abs(others[at + 2] - rungs[at + 1])],
    ['aliasing_dark', causes[at + 2]], ['aliasing_light', causes[at + 3]], ['acne', causes[at]],
    ['peter_panning', causes[at + 1]], ['coverage_dark', others[at]], ['coverage_light', others[at + 1]]
  ];
  if (taps > 1) steps.push(['precision', Math.abs(rungs[at + 3] - rungs[at + 2])]);
  let largest = '', size = 0;
  for (const [name, step] of steps)
    if (step > size) {
      size = step;
      largest = name;
    }
  return largest;
}

// The colour of pixel i. kind: 'shown', 'causes', 'truth' or 'error'.
function colourOf(kind, measured, receivers, colours, i) {
  const {answers} = measured, at = 4 * i, flags = answers.rungs[at];
  if (receivers.primitive[i] === noPrimitive) return colours.background;
  const cosine = Math.max(0, answers.others[at + 3]), truth = flags & 2 ? 1 : 0, shown = answers.rungs[at + 3] / answers.taps;
  if (kind === 'truth') return grey(0.15 + 0.75 * cosine * (flags ? truth : 0));
  if (kind === 'shown') return grey(0.15 + 0.75 * cosine * (flags ? shown : 0));
  if (!flags) return colours.attached;
  const error = shown - truth;
  if (kind === 'error') {
    // Too dark is the colour of acne, too light that of Peter Panning, white is right.
    const to = colours[error < 0 ? 'acne' : 'peter_panning'];
    return to.map(v => 255 + (v - 255) * Math.abs(error));
  }
  const right = colours[truth ? 'lit' : 'shadowed'].map(v => v * (0.72 + 0.28 * cosine)), cause = causeOf(answers, i);
  return cause ? colours[cause].map((v, k) => right[k] + (v - right[k]) * (0.25 + 0.75 * Math.abs(error))) : right;
}

function drawFrame(canvas, kind, measured, receivers, colours) {
  const context = canvas.getContext('2d'), image = context.createImageData(canvas.width, canvas.height);
  for (let i = 0; i < canvas.width * canvas.height; ++i) {
    const c = colourOf(kind, measured, receivers, colours, i);
    image.data.set([c[0], c[1], c[2], 255], 4 * i);
  }
  context.putImageData(image, 0, 0);
}

// stretched: from the least to the largest depth that is drawn; else as stored, from 0 (black) to 1 (white).
function drawMap(canvas, depths, stretched) {
  const context = canvas.getContext('2d'), image = context.createImageData(canvas.width, canvas.height);
  let low = 0, high = 1;
  if (stretched) {
    low = Infinity;
    high = -Infinity;
    for (const d of depths)
      if (d < 1) {
        low = Math.min(low, d);
        high = Math.max(high, d);
      }
    if (!(low < high)) [low, high] = [0, 1];
  }
  depths.forEach((d, i) => {
    const v = 255 * clamped((d - low) / (high - low), 0, 1);
    image.data.set([v, v, v, 255], 4 * i);
  });
  context.putImageData(image, 0, 0);
}
