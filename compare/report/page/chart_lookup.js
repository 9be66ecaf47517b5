// Error and causes of one point of a filtered map against a setting that only its lookup reads: lookup.reduction, whose usable
// window is shaded, and the setting of curve.over, whose values stand side by side, each with its name, because 0 has no place on
// a logarithmic axis.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit;
var series = ['error', 'exact_map', 'leak', 'reduction', 'over_darkening', 'peter_panning'];
var words = {error: 'Error that OpenGL shows', exact_map: 'Error on the exact map, without rounding'};
// Over-darkening and what the reduction darkens have colours of one family.
var dashes = {error: [5, 3], exact_map: [2, 2], over_darkening: [8, 2, 1.5, 2]};

function nameOf(s) {
  return words[s] || kit.causeLabel[s] || s;
}
function lookOf(s) {
  return words[s] ? {thick: 1.5, colour: 'var(--ink)'} : {thick: 2.4, colour: 'var(--c-' + s + ')'};
}

// The ends of a logarithmic axis for these values: it covers four decades below the largest.
function rangeOf(values) {
  var positive = values.filter(function(v) {
    return v > 0;
  });
  var top = 1.3 * Math.max.apply(null, positive.concat(1e-6)), least = Math.min.apply(null, positive.concat(top / 100));
  return {bottom: Math.max(least / 1.5, top / 3e4), top: top};
}
// Below the axis a line is left out, except for the parts by which it enters or leaves.
function onAxis(values, i, bottom) {
  return values[i] >= bottom || values[i - 1] >= bottom || values[i + 1] >= bottom;
}
// The shade of a usable window. from, to: encodings of x.
function windowMark(from, to, height) {
  return {
    type: 'rect',
    interactive: false,
    encode: {enter: {x: from, x2: to, y: {value: 0}, y2: {value: height}, fill: {value: 'var(--window)'}}}
  };
}
// Dashed lines at the bounds: [[0.001, 'acne bound'], ...]; one if both are equal. textX: where their names begin.
function boundMarks(bounds, width, textX) {
  if (bounds.length === 2 && bounds[0][0] === bounds[1][0]) bounds = [[bounds[0][0], 'bound']];
  return [].concat.apply(
      [],
      bounds
          .filter(function(b) {
            return b[0] > 0;
          })
          .map(function(b) {
            return [
              {
                type: 'rule',
                name: 'bound',
                interactive: false,
                encode: {
                  enter: {
                    x: {value: 0},
                    x2: {value: width},
                    y: {scale: 'y', value: b[0]},
                    stroke: {value: 'var(--faint)'},
                    strokeDash: {value: [3, 3]}
                  }
                }
              },
              {
                type: 'text',
                interactive: false,
                encode: {
                  enter: {
                    x: {value: textX},
                    y: {scale: 'y', value: b[0]},
                    dy: {value: -5},
                    align: {value: 'left'},
                    text: {value: b[1] + ' ' + kit.shown(b[0], 'fraction')},
                    fontSize: {value: 11}
                  }
                }
              }
            ];
          }));
}
// A line over the height at a value with a name: 'best' in the first row (0), 'as set' dashed in the second (1). side: -1: the
// name stands on the left of it.
function valueMarks(x, name, row, side, height) {
  var colour = row ? 'var(--accent)' : 'var(--good)';
  return [
    {
      type: 'rule',
      interactive: false,
      encode: {
        enter: {
          x: x,
          x2: x,
          y: {value: 20 + 16 * row},
          y2: {value: height},
          stroke: {value: colour},
          strokeWidth: {value: 1.4},
          strokeDash: {value: row ? [4, 3] : [1, 0]}
        }
      }
    },
    {
      type: 'text',
      interactive: false,
      encode: {
        enter: {
          x: x,
          y: {value: 32 + 16 * row},
          dx: {value: side * 5},
          align: {value: side < 0 ? 'right' : 'left'},
          text: {value: name},
          fill: {value: colour},
          fontWeight: {value: 600}
        }
      }
    }
  ];
}
// The series of the data `rows`, a line each. A row has series, v, colour, dash and thick. x: encoding of its place.
function lineMarks(x) {
  return {
    type: 'group',
    from: {facet: {name: 'one', data: 'rows', groupby: 'series'}},
    marks: [{
      type: 'line',
      from: {data: 'one'},
      interactive: false,
      encode: {
        enter: {
          x: x,
          y: {scale: 'y', field: 'v'},
          stroke: {field: 'colour'},
          strokeJoin: {value: 'round'},
          strokeDash: {field: 'dash'},
          strokeWidth: {field: 'thick'}
        }
      }
    }]
  };
}
// The line under the pointer, at the signal `hover`; none below 0.
function cursorMark(height) {
  return {
    type: 'rule',
    name: 'cursor',
    interactive: false,
    encode: {
      update: {
        x: {signal: 'hover'},
        y: {value: 0},
        y2: {value: height},
        stroke: {value: 'var(--soft)'},
        opacity: {signal: 'hover < 0 ? 0 : 0.6'}
      }
    }
  };
}
// The left axis.
function shareAxis(range) {
  return {
    orient: 'left',
    scale: 'y',
    grid: true,
    values: kit.logTicks(range.bottom, range.top),
    domain: false,
    ticks: false,
    title: 'share of counted receivers',
    encode: {labels: {update: {text: {signal: kit.axisLabel('fraction')}}}}
  };
}
// Follows the pointer along the entries of a curve. of: left, the room before the plot; count, of the entries; place(i), where
// entry i stands; nearest(px), the entry nearest to a place; tip(i), rows and title. Returns the stops for kit.keyboard().
function follow(view, plot, of) {
  var svg = plot.querySelector('svg');
  svg.addEventListener('mousemove', function(event) {
    var i = of.nearest(event.clientX - svg.getBoundingClientRect().left - of.left), said = of.tip(i);
    view.signal('hover', of.place(i)).run();
    kit.showTip(event, said.rows, said.title);
  });
  svg.addEventListener('mouseleave', function() {
    kit.hideTip();
    view.signal('hover', -1).run();
  });
  return function() {
    var box = svg.getBoundingClientRect(), stops = [];
    for (var i = 0; i < of.count; ++i)
      stops.push({element: svg, x: box.left + of.left + of.place(i), y: box.top + box.height / 3});
    return stops;
  };
}
// An entry of the legend: a swatch, or a line where the series is dashed.
function key(series) {
  var entry = kit.make('span'), look = lookOf(series), dash = dashes[series];
  if (dash)
    entry.innerHTML = '<svg viewBox="0 0 26 10" aria-hidden="true"><line x1="0" x2="26" y1="5" y2="5" stroke="' +
        look.colour + '" stroke-width="' + look.thick + '" stroke-dasharray="' + dash.join(' ') + '"/></svg>';
  else
    entry.append(kit.make('i', {class: 'sw c-' + series}));
  entry.append(nameOf(series));
  return entry;
}

// name: of the curve in the data of a point. Of a reduction the axis is linear.
function chartOver(place, name) {
  var curved = page.data.points.filter(function(p) {
    return p[name];
  });
  if (!curved.length) return;
  var recommended = kit.byId[page.data.recommended];
  var id = recommended && recommended[name] ? recommended.id : curved[0].id, linear = name === 'reductions';

  var stops, self = kit.chart(place, function(width) {
    var point = kit.byId[id], curve = point[name], values = curve.value;
    var left = 64, right = 16, w = width - left - right, h = width < 520 ? 260 : 340;
    var drawn = series.filter(function(s) {
      return curve[s].some(function(v) {
        return v > 0;
      });
    });
    stops = null;
    if (!drawn.length) {
      self.plot.append(kit.make('p', {class: 'small'}, 'The error is 0 at every value.'));
      return null;
    }
    // Pixels from the left end of the axis; not finite: the value has no place.
    function across(value) {
      if (linear) return value / values[values.length - 1] * w;
      var i = values.indexOf(value);
      return i < 0 ? NaN : i / Math.max(1, values.length - 1) * w;
    }
    function at(value) {
      return {value: across(value)};
    }
    var bounds = curve.acne_bound === undefined ?
        [] :
        [[curve.peter_panning_bound, 'bound on the leak'], [curve.acne_bound, 'bound on what is darkened']];
    var all = bounds.map(function(b) {
      return b[0];
    });
    drawn.forEach(function(s) {
      all = all.concat(curve[s]);
    });
    var range = rangeOf(all), rows = [];
    drawn.forEach(function(s) {
      values.forEach(function(value, i) {
        if (onAxis(curve[s], i, range.bottom))
          rows.push(Object.assign(
              {
                series: s,
                value: value,
                place: across(value),
                v: Math.max(curve[s][i], range.bottom),
                dash: dashes[s] || [1, 0]
              },
              lookOf(s)));
      });
    });
    var marks = [], usable = linear && kit.windowOfReduction(point);
    if (usable) marks.push(windowMark(at(usable.from), at(usable.to), h));
    marks = marks.concat(boundMarks(bounds, w, 4));
    marks.push(lineMarks({field: 'place'}));
    [[curve.least.value, 'least error', 0], [curve.as_set, 'as set', 1]].forEach(function(m) {
      var x = across(m[0]);
      if (kit.finite(x)) marks = marks.concat(valueMarks(at(m[0]), m[1], m[2], x > 0.7 * w ? -1 : 1, h));
    });
    marks.push(cursorMark(h));
    var title = curve.parameter + (curve.unit ? ' in ' + curve.unit : '');
    var scale = linear ? {type: 'linear', zero: true, domain: [0, values[values.length - 1]]} :
                         {type: 'point', domain: values.map(kit.digits)};
    return {
      spec: {
        width: w,
        height: h,
        padding: {left: left, right: right, top: 6, bottom: 46},
        autosize: 'none',
        signals: [{name: 'hover', value: -1}],
        data: [{name: 'rows', values: rows}],
        scales: [
          Object.assign({name: 'x', range: [0, w]}, scale),
          {name: 'y', type: 'log', zero: false, domain: [range.bottom, range.top], range: [h, 0]}
        ],
        axes: [shareAxis(range), {orient: 'bottom', scale: 'x', tickCount: 10, labelOverlap: true, title: title}],
        marks: marks
      },
      hover: function(view, plot) {
        stops = follow(view, plot, {
          left: left,
          count: values.length,
          place: function(i) {
            return across(values[i]);
          },
          nearest: function(px) {
            var best = 0;
            values.forEach(function(value, i) {
              if (Math.abs(across(value) - px) < Math.abs(across(values[best]) - px)) best = i;
            });
            return best;
          },
          tip: function(i) {
            return {
              rows: series.map(function(s) {
                return [nameOf(s), kit.shown(curve[s][i], 'fraction'), words[s] ? '' : s];
              }),
              title: curve.parameter + ' ' + kit.digits(values[i])
            };
          }
        });
      }
    };
  });
  if (!self) return;
  kit.keyboard(self, function() {
    return stops ? stops() : [];
  });
  var facts = kit.make('p', {class: 'facts'});
  self.legend.before(facts);
  function describe() {
    var point = kit.byId[id], curve = point[name], usable = linear && kit.windowOfReduction(point);
    facts.textContent = '';
    if (usable)
      facts.append(
          'Usable from ', kit.make('b', {}, kit.digits(usable.from)), ' to ', kit.make('b', {}, kit.digits(usable.to)),
          usable.placed ? ' at every placement of the grid. ' : '. ');
    else if (linear && point.no_window)
      facts.append(kit.make('b', {style: 'color:var(--bad)'}, 'The usable window is ' + point.no_window + '. '));
    else if (linear)
      facts.append(
          kit.make('b', {style: 'color:var(--bad)'}, 'No usable window. '),
          (curve.why || 'No reduction keeps the bounds') + '. ');
    facts.append(
        'Least error at ' + kit.digits(curve.least.value) + ', with ' + kit.shown(curve.least.error, 'fraction') + '.');
  }
  function controls() {
    self.controls.textContent = '';
    if (curved.length > 1) self.controls.append(kit.pointPicker(curved, id));
  }
  series.forEach(function(s) {
    self.legend.append(key(s));
  });
  page.onSelect.push(function(chosen) {
    if (!kit.byId[chosen][name]) return;
    id = chosen;
    controls();
    describe();
    self.draw();
  });
  controls();
  describe();
}
chartOver('reduction', 'reductions');
chartOver('over', 'over');
})();
