// The picture at every bias, or one picture of a stack. The element live-data holds the arrays that compare/ladder/live_picture.h or
// compare/ladder/picture_stack.h describes, compressed as compare/report/live_section.cpp packs them. Browsers unpack them
// only asynchronously; page.liveReady ends when the picture is drawn.
(function() {
'use strict';
var source = document.getElementById('live-data');
if (!source) return;
var page = window.noonmarkPage, kit = page.kit, make = kit.make, live = JSON.parse(source.textContent);
async function unpack() {
  var bytes = await noonmarkUnpack(live.data), n = live.answers, floats = new Uint8Array(4 * n);
  for (var i = 0; i < 4 * n; ++i) floats[4 * (i % n) + Math.floor(i / n)] = bytes[i];
  bytes.set(floats);
  return bytes;
}
function start(bytes) {
  var pixels = live.width * live.height, at = 0;
  function take(type, count) {
    var bytesOfOne = type.BYTES_PER_ELEMENT, part = bytes.buffer.slice(at, at + count * bytesOfOne);
    at += count * bytesOfOne;
    return new type(part);
  }
  // Of a stack the answers name the first picture that they are of, and of the other kind the least bias.
  var stack = live.kind === 'stack', floats = take(Float32Array, live.answers),
      bytesOf = take(Uint8Array, live.answers), cause = take(Uint8Array, live.answers),
      acne = stack ? null : take(Uint8Array, live.answers), peterPanning = stack ? null : take(Uint8Array, live.answers),
      flags = take(Uint8Array, pixels), cosine = take(Uint8Array, pixels),
      count = take(stack ? Uint8Array : Uint16Array, pixels), from = stack ? bytesOf : floats,
      lit = stack ? floats : bytesOf;
  var facing = 1, truthLit = 2, ambiguous = 4, surface = 8;  // LiveFlags
  // How much light an answer shows, from 0 to 1.
  function light(answer) {
    return stack ? lit[answer] : lit[answer] / live.taps;
  }
  function shownFrom(x) {
    var shown = new Int32Array(pixels).fill(-1), first = 0;
    for (var i = 0; i < pixels; ++i) {
      var end = first + count[i], k = first;
      if (flags[i] & facing) {
        while (k + 1 < end && from[k + 1] <= x) ++k;
        shown[i] = k;
      }
      first = end;
    }
    return shown;
  }

  // The bias in the parameter's own unit. Returns each pixel's answer (an index) and the shares of the counted receivers. Of a
  // stack it is one of its values; otherwise it is rounded to a float, as the shader gets it.
  function answersAt(bias) {
    if (stack) {
      var number = pictureOf(bias);
      return Object.assign({shown: shownFrom(number)}, live.values[number]);
    }
    var shown = shownFrom(Math.fround(bias)), counted = 0, wrong = 0, a = 0, p = 0;
    shown.forEach(function(k, i) {
      if (k < 0 || flags[i] & ambiguous) return;
      ++counted;
      wrong += flags[i] & truthLit ? live.taps - lit[k] : lit[k];
      a += acne[k];
      p += peterPanning[k];
    });
    var taps = counted * live.taps;
    return {shown: shown, counted: counted, error: wrong / taps, acne: a / taps, peter_panning: p / taps};
  }
  // The number of the stack's picture at this value, or -1.
  function pictureOf(value) {
    return live.values.findIndex(function(v) {
      return same(value, v.value);
    });
  }
  function same(a, b) {  // one of them may have been converted from another unit
    return Math.abs(a - b) <= 1e-9 * Math.abs(b);
  }

  var figure = document.getElementById('live-picture'), canvas = figure.querySelector('canvas'),
      slider = figure.querySelector('input'), facts = figure.querySelector('.facts'), context = canvas.getContext('2d'),
      kind = 'map';
  function colour(name) {
    var text = getComputedStyle(document.documentElement).getPropertyValue('--c-' + name).trim();
    return [1, 3, 5].map(function(k) {
      return parseInt(text.slice(k, k + 2), 16);
    });
  }
  var colours = {};
  ['background', 'attached', 'ambiguous', 'lit', 'shadowed'].concat(live.causes.slice(1)).forEach(function(name) {
    colours[name] = colour(name);
  });
  function grey(linear) {
    var v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * Math.pow(linear, 1 / 2.4) - 0.055;
    return [255 * v, 255 * v, 255 * v];
  }
  function colourOf(i, answer) {
    if (!(flags[i] & surface)) return colours.background;
    var n = cosine[i] / 255, truth = flags[i] & truthLit ? 1 : 0;
    if (kind === 'truth') return grey(0.15 + 0.75 * n * (flags[i] & facing ? truth : 0));
    if (answer < 0) return kind === 'map' ? grey(0.15) : colours.attached;
    var seen = light(answer);
    if (kind === 'map') return grey(0.15 + 0.75 * n * seen);
    if (flags[i] & ambiguous) return colours.ambiguous;
    var right = colours[truth ? 'lit' : 'shadowed'].map(function(v) {
      return v * (0.72 + 0.28 * n);
    });
    if (!cause[answer]) return right;
    var strength = 0.25 + 0.75 * Math.abs(seen - truth);
    return colours[live.causes[cause[answer]]].map(function(v, k) {
      return right[k] + (v - right[k]) * strength;
    });
  }

  // The slider: 0, then a logarithmic scale from one quantum of 24 bits to the depth of the whole map. Of a stack it has a
  // step for each stop: each picture, and the recommended bias if the point has its own pictures there.
  var least = 1e-7, steps = 1400, stops = [];
  function depthAt(position) {
    if (stack) return stops[Math.round(position)];
    return position <= 0 ? 0 : least * Math.pow(1 / least, (position - 1) / (steps - 1));
  }
  function positionOf(depth) {
    if (!stack) return depth < least ? 0 : 1 + (steps - 1) * Math.log(depth / least) / Math.log(1 / least);
    var after = stops.findIndex(function(v) {
      return v >= depth || same(v, depth);
    });
    if (after <= 0) return after < 0 ? steps : 0;
    return after - (stops[after] - depth) / (stops[after] - stops[after - 1]);
  }
  // The nearest value that has a picture. A bias on the page is in window depth, and one of a stack in the parameter's unit.
  function snapped(value) {
    return !stack ? value : stops.reduce(function(best, v) {
      return Math.abs(v - value) < Math.abs(best - value) ? v : best;
    });
  }
  function fromDepth(d) {
    return stack && live.depth_per_unit ? d / live.depth_per_unit : d;
  }
  // In window depth; of a stack in the parameter's unit.
  var depth = 0;
  function text(d) {
    if (stack && !live.depth_per_unit) return kit.shown(d, live.unit);
    var inDepth = stack ? d * live.depth_per_unit : d;
    return kit.digits(inDepth * live.m_per_depth) + ' m = ' + kit.digits(inDepth * live.texels_per_depth) +
        ' texels = ' + kit.digits(inDepth) + ' depth';
  }
  // The point's own pictures, in full size, are of the bias as set, and some of the recommended one. They are shown at these
  // biases, and the live picture at every other.
  var recommended = ' as recommended', choices = [], whole = make('img', {class: 'whole', hidden: ''});
  canvas.before(whole);
  function own(name) {
    return document.querySelector('.pictures[data-point="' + live.point + '"] figure[data-name="' + name + '"] img');
  }
  function isAt(mark) {
    return same(depth, mark);
  }
  // Whether the recommended value is one of the setting on the slider.
  function isOfStage(at) {
    return Boolean(at) && at.parameter === live.parameter;
  }
  // The recommended bias of the point, if the page has the point's pictures there.
  function recommendedBias() {
    var p = kit.byId[live.point];
    return p && isOfStage(p.at) && own('map' + recommended) ? (stack ? p.at.value : p.at.depth) : NaN;
  }
  if (stack) {
    stops = live.values.map(function(v) {
      return v.value;
    });
    if (pictureOf(recommendedBias()) < 0 && isFinite(recommendedBias())) stops.push(recommendedBias());
    stops.sort(function(a, b) {
      return a - b;
    });
    steps = stops.length - 1;
  }
  slider.min = 0;
  slider.max = steps;
  slider.step = 1;
  // Shows it, if there is one at this bias, and returns the numbers of the point there.
  function showWhole() {
    var p = kit.byId[live.point], name = kind === 'causes' ? 'classes' : kind, found = null, numbers = null;
    if (isAt(live.marks.set)) {
      found = own(name);
      numbers = {metrics: p.metrics, words: ', as set'};
    } else if (isAt(recommendedBias())) {
      found = own(kind === 'truth' ? name : name + recommended);  // no bias changes the truth
      numbers = {metrics: p.at.metrics, words: p.at.usable ? ', recommended' : ', of least error, not usable'};
    }
    whole.hidden = !found;
    canvas.hidden = Boolean(found);
    if (!found) return null;
    if (whole.src !== found.src) whole.src = found.src;
    whole.alt = found.alt;
    return numbers;
  }
  var told = live.told || ['acne', 'peter_panning'];
  function tell(words, values) {
    facts.textContent = '';
    facts.append(
        make('b', {}, live.parameter), ' ' + text(depth) + words + ' · error ',
        make('b', {}, kit.shown(values.error, 'fraction')));
    told.forEach(function(cause) {
      var name = (kit.causeLabel[cause] || cause).replace(/ \(.*/, '');
      if (name !== 'Peter Panning') name = name.charAt(0).toLowerCase() + name.slice(1);
      facts.append(' · ' + name + ' ', make('b', {}, kit.shown(values[cause], 'fraction')));
    });
  }
  function draw() {
    slider.setAttribute('aria-valuetext', text(depth));
    choices.forEach(function(c) {
      c.button.setAttribute('aria-pressed', String(isAt(c.depth)));
    });
    var numbers = showWhole(), now = stack && pictureOf(depth) < 0 ? null : paint();
    tell(numbers ? numbers.words : '', numbers ? numbers.metrics : now);
  }
  // The live picture. Returns its numbers.
  function paint() {
    var now = answersAt(stack ? depth : depth / live.depth_per_unit), image = context.createImageData(live.width, live.height);
    for (var i = 0; i < pixels; ++i) {
      image.data.set(colourOf(i, now.shown[i]), 4 * i);
      image.data[4 * i + 3] = 255;
    }
    context.putImageData(image, 0, 0);
    return now;
  }
  function set(d) {
    depth = snapped(d);
    slider.value = Math.round(positionOf(depth));
    draw();
  }
  slider.addEventListener('input', function() {
    depth = depthAt(+slider.value);
    draw();
  });
  var controls = figure.querySelector('.controls'), marks = figure.querySelector('.bias-marks');
  function show(k) {
    kind = k;
    draw();
  }
  controls.append(kit.segments([['truth', 'Truth'], ['map', 'Map'], ['causes', 'Causes']], kind, show));
  [['set', 'As set'], ['recommended', 'Recommended'], ['best', 'Best for this point']].forEach(function(m) {
    if (!(m[0] in live.marks) || !same(snapped(live.marks[m[0]]), live.marks[m[0]])) return;
    function go() {
      set(live.marks[m[0]]);
    }
    var button = make('button', {type: 'button', on: {click: go}}, m[1]);
    choices.push({depth: live.marks[m[0]], button: button});
    controls.append(button);
    marks.append(make('i', {class: 'mark ' + m[0], style: 'left:' + 100 * positionOf(live.marks[m[0]]) / steps + '%'}));
  });
  stops.forEach(function(_, k) {
    marks.prepend(make('i', {class: 'stop', style: 'left:' + 100 * k / steps + '%'}));
  });
  if (live.marks.window) {
    var low = 100 * positionOf(live.marks.window[0]) / steps, high = 100 * positionOf(live.marks.window[1]) / steps;
    marks.prepend(make('i', {class: 'window', style: 'left:' + low + '%;width:' + (high - low) + '%'}));
  }
  var legend = figure.querySelector('.legend');
  live.causes.slice(1).forEach(function(name, k) {
    if (cause.indexOf(k + 1) >= 0)
      legend.append(make('span', {}, [make('i', {class: 'sw c-' + name}), kit.causeLabel[name] || name]));
  });
  // The recommended bias of the point, or the best of its curve.
  function best() {
    var p = kit.byId[live.point];
    if (p && isOfStage(p.at)) return fromDepth(p.at.depth);
    return 'recommended' in live.marks ? live.marks.recommended : 'best' in live.marks ? live.marks.best : depth;
  }
  function follow() {
    set(page.bias === 'set' && 'set' in live.marks ? live.marks.set : best());
  }
  page.onBias.push(follow);
  // Whether there is a picture at a recommended value of a point (at_bias() in report/point_data.h).
  function has(at) {
    return isOfStage(at) && (!stack || pictureOf(fromDepth(at.depth)) >= 0);
  }
  // A picture of the given kind at such a bias, as a data: address.
  function pictureAt(d, wanted) {
    var held = [depth, kind];
    kind = wanted;
    depth = fromDepth(d);
    paint();
    var address = canvas.toDataURL();
    kind = held[1];
    set(held[0]);
    return address;
  }
  // The pixel that is most wrong by a cause, or by 'error' by any, at a bias that has a picture; null if there is none.
  function worst(name, d) {
    var now = answersAt(d / live.depth_per_unit), wanted = live.causes.indexOf(name), found = null;
    for (var i = 0; i < pixels; ++i) {
      var k = now.shown[i];
      if (k < 0 || flags[i] & ambiguous || !cause[k] || (name !== 'error' && cause[k] !== wanted)) continue;
      var error = Math.abs(light(k) - (flags[i] & truthLit ? 1 : 0));
      if (!found || error > found.error)
        found = {x: i % live.width, y: Math.floor(i / live.width), error: error, cause: live.causes[cause[k]]};
    }
    return found;
  }
  follow();
  page.live = {
    data: live,
    stops: stops,
    set: set,
    has: has,
    show: show,
    canvas: canvas,
    pictureAt: pictureAt,
    worst: worst
  };
}
page.liveReady = 'DecompressionStream' in window ? unpack().then(start) : Promise.resolve().then(function() {
  document.querySelector('#live-picture .facts').textContent =
      'This browser cannot unpack the live picture. Use Chrome 80, Firefox 113, Safari 16.4 or a later one.';
});
})();
