// What the chart of cost against error is drawn from: shapes, places, labels, and Vega's marks.
(function() {
'use strict';
var kit = window.noonmarkPage.kit;

// Shapes that can be told apart at this size; values beyond the last get a number. Paths in the units of Vega's symbols:
// from -1 to 1.
var shapes = [
  'M0.8 0A0.8 0.8 0 1 1 -0.8 0A0.8 0.8 0 1 1 0.8 0Z', 'M-0.72 -0.72H0.72V0.72H-0.72Z', 'M0 -0.95L0.95 0.75H-0.95Z',
  'M0 -1.05L0.8 0L0 1.05L-0.8 0Z', 'M0 0.95L0.95 -0.75H-0.95Z',
  'M-0.32 -0.95H0.32V-0.32H0.95V0.32H0.32V0.95H-0.32V0.32H-0.95V-0.32H-0.32Z', 'M-0.75 -0.95L0.95 0L-0.75 0.95Z',
  'M0 -1.1L0.3 -0.36L1.05 -0.34L0.47 0.15L0.65 0.9L0 0.48L-0.65 0.9L-0.47 0.15L-1.05 -0.34L-0.3 -0.36Z',
  'M-0.85 -0.9H0.85L-0.85 0.9H0.85Z', 'M0.75 -0.95L-0.95 0L0.75 0.95Z'
];
var cross = 'M-0.8 -0.8L0.8 0.8M-0.8 0.8L0.8 -0.8', disc = 'M1 0A1 1 0 1 1 -1 0A1 1 0 1 1 1 0Z';

// Each choice stands at its cost. Returns the scale of x; each row gets its place `px`, and that of its interval.
function place(rows, w) {
  var low = Infinity, high = -Infinity, room = 14;
  rows.forEach(function(r) {
    low = Math.min(low, r.low), high = Math.max(high, r.high);
  });
  var log = low > 0, same = low === high, domain = [low, high];
  if (same) domain = log ? [low / 2, high * 2] : [low - 1, high + 1];
  function at(x) {
    var t = log ? Math.log(x / domain[0]) / Math.log(domain[1] / domain[0]) : (x - domain[0]) / (domain[1] - domain[0]);
    return room + t * (w - 2 * room);
  }
  rows.forEach(function(r) {
    r.px = at(r.x), r.pxLow = at(r.low), r.pxHigh = at(r.high);
  });
  return {name: 'x', type: log ? 'log' : 'linear', zero: false, nice: false, domain: domain, range: [room, w - room]};
}

// Marks of equal cost whose errors are nearly equal would hide each other. Such choices share one mark, at the place of the
// first of them by `before`; its `others` are the rest. y(row): where the row stands, in pixels. Returns the rows with marks.
function together(rows, y, before) {
  var least = 11, marks = [];
  rows.slice().sort(before).forEach(function(r) {
    var mark = marks.filter(function(m) {
      return m.x === r.x && Math.abs(y(m) - y(r)) < least;
    })[0];
    r.others = [];
    if (mark)
      mark.others.push(r);
    else
      marks.push(r);
  });
  return marks;
}

// What a mark at a choice's place enters with.
function placed(more) {
  return Object.assign({x: {field: 'px'}, y: {scale: 'y', field: 'y'}}, more);
}

// Puts the labels of curves beside the plot, one below the other, in the order in which the curves end, each as near to that end
// as the others leave room. Each has `at`, where its curve ends in pixels, and `must`: where there is no room for all, some
// without it are left out. Returns those with a place, `py`.
function spread(labels, height) {
  var line = 14, most = Math.floor(height / line) + 1;
  var kept = labels.slice()
                 .sort(function(a, b) {
                   return b.must - a.must || a.at - b.at;
                 })
                 .slice(0, most)
                 .sort(function(a, b) {
                   return a.at - b.at;
                 });
  // Labels that would overlap form a block, whose middle is that of the ends of their curves.
  var blocks = [];
  kept.forEach(function(label, i) {
    var block = {sum: label.at - i * line, labels: [label]};
    function before() {
      var last = blocks[blocks.length - 1];
      return last && last.sum / last.labels.length >= block.sum / block.labels.length ? blocks.pop() : null;
    }
    for (var joined = before(); joined; joined = before())
      block = {sum: joined.sum + block.sum, labels: joined.labels.concat(block.labels)};
    blocks.push(block);
  });
  var room = Math.max(0, height - (kept.length - 1) * line), n = 0;
  blocks.forEach(function(block) {
    var top = Math.min(room, Math.max(0, block.sum / block.labels.length));
    block.labels.forEach(function(label) {
      label.py = top + line * n++;
    });
  });
  return kept;
}

// The width beside the plot for labels of these texts: a letter of bold text has some 8 pixels. Longer ones are cut.
function roomFor(texts) {
  return Math.min(280, 40 + 8 * Math.max.apply(null, [16].concat(texts.map(function(text) {
    return text.length;
  }))));
}
// Ticks of a logarithmic axis so far apart that their labels do not touch.
function ticks(scale, w) {
  var low = scale.domain[0], high = scale.domain[1], last = -Infinity;
  return kit.logTicks(low, high).filter(function(v) {
    var at = w * Math.log(v / low) / Math.log(high / low);
    if (at - last < 58) return false;
    last = at;
    return true;
  });
}

// A text that can be read over lines: the same text behind it, wide and in the colour of the page.
function readable(name, source, encode) {
  return [
    {stroke: {value: 'var(--card)'}, strokeWidth: {value: 4}, strokeJoin: {value: 'round'}, fill: {value: 'none'}}, {}
  ].map(function(more, i) {
    return {
      type: 'text',
      name: name + (i ? '' : '-halo'),
      from: {data: source},
      interactive: false,
      encode: {enter: Object.assign({}, encode, more)}
    };
  });
}

// From the end of a curve to its label.
function leaders(w) {
  return {
    type: 'rule',
    name: 'leaders',
    from: {data: 'labels'},
    interactive: false,
    encode: {
      enter: {
        x: {field: 'from', offset: 8},
        x2: {value: w + 14},
        y: {field: 'at'},
        y2: {field: 'py'},
        stroke: {field: 'colour'},
        strokeWidth: {signal: 'datum.must ? 1.4 : 0.7'},
        strokeOpacity: {value: 0.7}
      }
    }
  };
}

// right: the width beside the plot, for the labels of curves.
function marksOf(w, floor, right) {
  function ring(source, colour) {
    return {
      type: 'symbol',
      name: source + '-ring',
      from: {data: source},
      interactive: false,
      encode: {
        enter:
            placed({size: {value: 360}, fill: {value: 'transparent'}, stroke: {value: colour}, strokeWidth: {value: 2}})
      }
    };
  }
  return [
    {
      type: 'rule',
      name: 'span-bars',
      from: {data: 'spans'},
      interactive: false,
      encode: {
        enter: {
          x: {field: 'px'},
          y: {scale: 'y', field: 'top'},
          y2: {scale: 'y', field: 'bottom'},
          stroke: {field: 'colour'},
          strokeOpacity: {value: 0.55},
          strokeWidth: {value: 2.2}
        }
      }
    },
    {
      type: 'rule',
      name: 'cost-bars',
      from: {data: 'intervals'},
      interactive: false,
      encode: {
        enter: {
          x: {field: 'pxLow'},
          x2: {field: 'pxHigh'},
          y: {scale: 'y', field: 'y'},
          stroke: {value: 'var(--soft)'},
          strokeOpacity: {value: 0.55},
          strokeWidth: {value: 1.6}
        }
      }
    },
    {
      type: 'group',
      from: {facet: {name: 'one', data: 'curves', groupby: 'technique'}},
      marks: [{
        type: 'line',
        name: 'technique-lines',
        from: {data: 'one'},
        interactive: false,
        encode: {
          enter: placed({
            stroke: {field: 'colour'},
            strokeWidth: {signal: 'datum.ahead ? 2.4 : 1'},
            strokeOpacity: {signal: 'datum.ahead ? 0.95 : 0.5'},
            strokeJoin: {value: 'round'}
          })
        }
      }]
    },
    {
      type: 'line',
      name: 'front-line',
      from: {data: 'front'},
      interactive: false,
      encode: {
        enter: placed({
          interpolate: {value: 'step-after'},
          stroke: {value: 'var(--accent)'},
          strokeDash: {value: [2, 3]},
          strokeWidth: {value: 1.5},
          strokeOpacity: {value: 0.8}
        })
      }
    },
    {
      type: 'symbol',
      name: 'choice-marks',
      from: {data: 'rows'},
      encode: {
        enter: placed({
          size: {field: 'size'},
          shape: {field: 'shape'},
          fill: {signal: 'datum.counts ? datum.fill : \'transparent\''},
          stroke: {signal: 'datum.counts ? \'var(--ink)\' : \'var(--bad)\''},
          strokeWidth: {signal: 'datum.counts ? 1.1 : datum.strong ? 2 : 1.2'},
          strokeDash: {signal: 'datum.held ? [1, 0] : [2, 2]'},
          opacity: {signal: 'datum.strong ? 1 : 0.6'}
        }),
        update: {size: {field: 'size'}},
        hover: {size: {signal: 'datum.size + 80'}}
      }
    },
    {
      type: 'text',
      from: {data: 'rows'},
      interactive: false,
      encode: {
        enter: placed({
          align: {value: 'center'},
          baseline: {value: 'middle'},
          fontSize: {value: 8.5},
          fontWeight: {value: 700},
          text: {field: 'number'},
          fill: {value: 'var(--ink)'}
        })
      }
    },
    {
      type: 'text',
      name: 'counts',
      from: {data: 'rows'},
      interactive: false,
      encode: {
        enter: placed({
          dx: {signal: 'datum.px > ' + (w - 34) + ' ? -9 : 9'},
          align: {signal: 'datum.px > ' + (w - 34) + ' ? \'right\' : \'left\''},
          baseline: {value: 'bottom'},
          dy: {value: -2},
          fontSize: {value: 11},
          text: {signal: 'datum.counted && length(datum.others) ? \'+\' + length(datum.others) : \'\''},
          fill: {value: 'var(--soft)'}
        })
      }
    },
    ring('answers', 'var(--good)'), ring('chosen', 'var(--accent)')
  ]
      .concat(
          leaders(w), readable('curve-names', 'labels', {
            x: {value: w + 18},
            y: {field: 'py'},
            baseline: {value: 'middle'},
            limit: {value: right - 40},
            text: {field: 'text'},
            fontSize: {value: 12},
            fontWeight: {signal: 'datum.must ? 600 : 400'},
            fill: {signal: 'datum.must ? \'var(--ink)\' : \'var(--soft)\''}
          }),
          readable('curve-ends', 'ends', {
            x: {field: 'from', offset: 10},
            y: {field: 'at'},
            baseline: {value: 'middle'},
            text: {field: 'text'},
            fontSize: {value: 12},
            fontWeight: {signal: 'datum.must ? 600 : 400'},
            fill: {signal: 'datum.must ? \'var(--ink)\' : \'var(--soft)\''}
          }),
          readable('answer-names', 'answers', {
            // Within the plot, so that no label of an axis is below it: a letter of bold text has some 7 pixels.
            x: {signal: 'clamp(datum.px, 3.5 * length(datum.answer), ' + w + ' - 3.5 * length(datum.answer))'},
            y: {scale: 'y', field: 'y'},
            dy: {value: 22},
            align: {value: 'center'},
            text: {field: 'answer'},
            fill: {value: 'var(--good)'},
            fontWeight: {value: 600}
          }),
          kit.zeroLabel(floor));
}

kit.speed = {
  shapes: shapes,
  cross: cross,
  disc: disc,
  spread: spread,
  roomFor: roomFor,
  ticks: ticks,
  place: place,
  together: together,
  marksOf: marksOf
};
})();
