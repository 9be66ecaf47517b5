// The phase diagrams: texel size against bias. A cell's colour is the cause with the largest share, and it is stronger
// the larger the error is. The points of a sweep are rings on it.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit;
var causes = ['acne', 'peter_panning', 'aliasing', 'coverage', 'filter', 'undecided'];
var least = 1e-5;  // an error below this share has the colour of the page

function edges(list) {  // the borders between the values of a logarithmic axis
  var out = [], n = list.length;
  for (var i = 0; i <= n; ++i) {
    var a = list[Math.max(0, i - 1)], b = list[Math.min(n - 1, i)];
    if (i === 0) a = list[0] * list[0] / list[1];
    if (i === n) b = list[n - 1] * list[n - 1] / list[n - 2];
    out.push(Math.sqrt(a * b));
  }
  return out;
}
function draw(phase, number) {
function commandOf(row, bias) {
  return phase.render + ' --set map.resolution=' + row.resolution + ' --set bias.constant=' +
      String(+(bias * phase.per_metre).toPrecision(6));
}

var said = kit.make('p', {class: 'small command'});
function pointsTip(event, place) {
  kit.showTip(
      event, place.points.map(function(id) {
        var p = kit.byId[id];
        return [kit.nameOf(p), kit.shown(kit.value(p, 'error'), 'fraction')];
      }),
      'Texel ' + metres(place.t) + ', bias ' + metres(place.b) + '; error');
}
function choose(place) {
  page.select(place.points[0]);
  if (place.points.length === 1) page.open(place.points[0]);
  said.textContent = '';
  said.append(place.points.length > 1 ? 'Points of the sweep: ' : 'Point of the sweep: ');
  place.points.forEach(function(id, i) {
    said.append(i ? ', ' : '', kit.make('a', {href: '#p' + id}, 'point ' + id));
  });
}
function tellCommand(cell) {
  said.textContent = '';
  said.append('This point: ', kit.make('code', {}, commandOf(phase.rows[cell.row], phase.bias_m[cell.bias])));
}
// The sweep's points, those at the same place together.
var places;
// The cell that the arrow keys chose, and what is needed to find it in the drawing.
var cursor = null, grid = null;
function place() {
  var found = {};
  phase.points.forEach(function(p) {
    var point = kit.byId[p.id];
    if (!point || !kit.finite(p.texel_m) || !kit.finite(p.bias_m)) return;
    var moved = page.bias === 'recommended' && point.at && point.curve && point.at.parameter === 'bias.constant';
    var bias = moved ? point.at.depth * point.curve.m_per_depth : p.bias_m;
    var key = p.texel_m.toPrecision(3) + ' ' + bias.toPrecision(3);
    (found[key] = found[key] || {t: p.texel_m, b: bias, points: []}).points.push(p.id);
  });
  places = Object.keys(found).map(function(key) {
    return found[key];
  });
}
place();
function metres(m) {
  return m < 1 ? kit.digits(1000 * m) + '\u202fmm' : kit.digits(m) + '\u202fm';
}
var self = kit.chart(number ? 'phase-' + (number + 1) : 'phase', function(width) {
  var left = 74, right = 66, w = width - left - right, h = Math.round(Math.min(520, Math.max(300, w * 0.56)));
  var bias = phase.bias_m, x = edges(bias), texels = phase.rows.map(function(r) {
    return r.texel_m;
  });
  var y = edges(texels), cells = [];
  phase.rows.forEach(function(row, j) {
    bias.forEach(function(b, i) {
      var cause = '', largest = 0;
      causes.forEach(function(c) {
        if (row[c][i] > largest) {
          largest = row[c][i];
          cause = c;
        }
      });
      var strength = row.error[i] > least ? Math.log(row.error[i] / least) / Math.log(0.3 / least) : 0;
      cells.push({
        x: x[i],
        x2: x[i + 1],
        y: y[j],
        y2: y[j + 1],
        fill: cause ? 'var(--c-' + cause + ')' : 'transparent',
        strength: Math.max(0, Math.min(1, strength)),
        row: j,
        bias: i
      });
    });
  });
  var low = x[0], high = x[x.length - 1], fine = Math.min(y[0], y[y.length - 1]), coarse = Math.max(y[0], y[y.length - 1]);
  // Where a series passes its bound, in every row; between two biases by the logarithm of the bias.
  function border(series, bound, falls) {
    return phase.rows
        .map(function(row) {
          var s = row[series], n = s.length, i = 0;
          if (falls)
            while (i < n && !(s[i] <= bound)) ++i;
          else
            while (i < n && s[i] <= bound) ++i;
          return {b: i === 0 ? low : i === n ? null : Math.sqrt(bias[i - 1] * bias[i]), t: row.texel_m};
        })
        .filter(function(p) {
          return p.b !== null && p.b > low;
        });
  }
  function law(factor) {
    if (!kit.finite(factor) || factor <= 0) return [];
    var from = Math.max(fine, low / factor), to = Math.min(coarse, high / factor);
    return from < to ? [{b: from * factor, t: from}, {b: to * factor, t: to}] : [];
  }
  var acne = phase.acne_bound, panning = phase.peter_panning_bound, lines = [
    {name: 'acne_worst', points: border('acne_worst', acne, true), stroke: 'var(--border-acne)', dash: [1, 0], width: 2.4},
    {name: 'acne_mean', points: border('acne', acne, true), stroke: 'var(--border-acne)', dash: [6, 4], width: 1.5},
    {
      name: 'panning_worst',
      points: border('peter_panning_worst', panning, false),
      stroke: 'var(--border-panning)',
      dash: [1, 0],
      width: 2.4
    },
    {name: 'panning_mean', points: border('peter_panning', panning, false), stroke: 'var(--border-panning)', dash: [6, 4], width: 1.5},
    {name: 'law', points: law(phase.law_at_bound), stroke: 'var(--ink)', dash: [9, 3, 2, 3], width: 1.3},
    {name: 'steepest', points: law(phase.law_steepest), stroke: 'var(--ink)', dash: [1.5, 3.5], width: 1.3}
  ];
  // Hatching: short strokes within the usable interval of each row, so that they join from row to row.
  function px(b) {
    return w * Math.log(b / low) / Math.log(high / low);
  }
  function py(t) {
    return h * Math.log(t / coarse) / Math.log(fine / coarse);
  }
  var hatch = [], tip = null;
  phase.rows.forEach(function(row, j) {
    if (!row.usable) return;
    if (!tip) tip = {b: Math.sqrt(row.usable[0] * row.usable[1]), t: row.texel_m, row: row};
    var a = px(row.usable[0]), b = px(row.usable[1]), top = py(Math.max(y[j], y[j + 1])),
        bottom = py(Math.min(y[j], y[j + 1])), tall = bottom - top;
    // Strokes of the family x + y = 9 k.
    for (var k = Math.ceil((a + top) / 9); 9 * k <= b + bottom; ++k) {
      var x1 = 9 * k - bottom, y1 = bottom, x2 = 9 * k - top, y2 = top;
      if (x1 < a) {
        y1 -= a - x1;
        x1 = a;
      }
      if (x2 > b) {
        y2 += x2 - b;
        x2 = b;
      }
      if (x2 > x1) hatch.push({x: x1, y: y1, x2: x2, y2: y2});
    }
  });
  function scale(name, range, domain) {
    return {name: name, type: 'log', domain: domain, range: range, nice: false, zero: false};
  }
  var metre = 'datum.value < 0.001 ? format(datum.value * 1e6, \'~r\') + \'\u202fµm\' : datum.value < 1 ? ' +
      'format(datum.value * 1000, \'~r\') + \'\u202fmm\' : format(datum.value, \'~r\') + \'\u202fm\'';
  var product = phase.rows[0].resolution * phase.rows[0].texel_m, resolutions = [];
  for (var n = 16; n <= 65536; n *= 2)
    if (product / n >= fine && product / n <= coarse) resolutions.push(product / n);
  var marks = [
    {
      type: 'rect',
      from: {data: 'cells'},
      encode: {
        enter: {
          x: {scale: 'x', field: 'x'},
          x2: {scale: 'x', field: 'x2'},
          y: {scale: 'y', field: 'y'},
          y2: {scale: 'y', field: 'y2'},
          fill: {field: 'fill'},
          fillOpacity: {field: 'strength'}
        }
      }
    },
    {
      type: 'rule',
      interactive: false,
      from: {data: 'hatch'},
      encode: {
        enter: {
          x: {field: 'x'},
          y: {field: 'y'},
          x2: {field: 'x2'},
          y2: {field: 'y2'},
          stroke: {value: 'var(--ink)'},
          strokeOpacity: {value: 0.42},
          strokeWidth: {value: 1}
        }
      }
    }
  ];
  lines.forEach(function(line) {
    marks.push({
      type: 'line',
      interactive: false,
      clip: true,
      from: {data: line.name},
      encode: {
        enter: {
          x: {scale: 'x', field: 'b'},
          y: {scale: 'y', field: 't'},
          stroke: {value: line.stroke},
          strokeWidth: {value: line.width},
          strokeDash: {value: line.dash}
        }
      }
    });
  });
  place();
  // A bias of 0, or beyond the axis, is on the axis' end.
  var rings = places.map(function(p) {
    return {
      b: Math.max(low, Math.min(high, p.b)),
      t: Math.max(fine, Math.min(coarse, p.t)),
      place: p,
      size: p.points.length > 1 ? 120 : 70
    };
  });
  // The tip's name, on a rim in the page's colour, within the plot.
  var half = 100;  // of its width, in pixels
  if (tip)
    [4, 0].forEach(function(rim) {
      marks.push({
        type: 'text',
        interactive: false,
        encode: {
          enter: {
            x: {value: half > w / 2 ? w / 2 : Math.max(half, Math.min(w - half, px(tip.b)))},
            y: {scale: 'y', value: tip.t},
            dy: {value: py(tip.t) < 40 ? 34 : -14},
            align: {value: 'center'},
            text: {value: 'usable up to ' + metres(tip.t) + ' a texel'},
            fontWeight: {value: 600},
            fill: {value: 'var(--ink)'},
            stroke: {value: rim ? 'var(--card)' : 'transparent'},
            strokeWidth: {value: rim}
          }
        }
      });
    });
  [{stroke: 'var(--card)', width: 5}, {stroke: 'var(--ink)', width: 2}].forEach(function(rim) {
    marks.push({
      type: 'symbol',
      from: {data: 'rings'},
      encode: {
        enter: {
          x: {scale: 'x', field: 'b'},
          y: {scale: 'y', field: 't'},
          size: {field: 'size'},
          fill: {value: 'transparent'},
          stroke: {value: rim.stroke},
          strokeWidth: {value: rim.width}
        }
      }
    });
  });
  grid = {left: left, top: 12, x: x.map(px), y: y.map(py), places: places};
  return {
    measure: 'error',
    spec: {
      width: w,
      height: h,
      padding: {left: left, right: right, top: 12, bottom: 48},
      autosize: 'none',
      data: [{name: 'cells', values: cells}, {name: 'hatch', values: hatch}, {name: 'rings', values: rings}].concat(lines.map(function(line) {
        return {name: line.name, values: line.points};
      })),
      scales: [scale('x', [0, w], [low, high]), scale('y', [h, 0], [fine, coarse])],
      axes: [
        {
          orient: 'bottom',
          scale: 'x',
          title: 'constant bias along the light',
          values: kit.logTicks(low, high),
          labelOverlap: true,
          labelSeparation: 6,
          encode: {labels: {update: {text: {signal: metre}}}}
        },
        {
          orient: 'left',
          scale: 'y',
          title: 'width of a texel',
          minExtent: 54,  // labels such as 500 µm: Vega measures them too narrow, and the title would touch them
          values: kit.logTicks(fine, coarse),
          encode: {labels: {update: {text: {signal: metre}}}}
        },
        {
          orient: 'right',
          scale: 'y',
          title: 'resolution',
          minExtent: 46,
          values: resolutions,
          encode: {labels: {update: {text: {signal: 'format(round(' + product + ' / datum.value), \'d\')'}}}}
        }
      ],
      marks: marks
    },
    hover: function(view) {
      view.addEventListener('mousemove', function(event, item) {
        var d = item && item.datum;
        if (d && d.place) return pointsTip(event, d.place);
        if (!d || d.row === undefined) return kit.hideTip();
        var row = phase.rows[d.row], i = d.bias, rows = [
          ['error, mean', kit.shown(row.error[i], 'fraction')], ['error, worst', kit.shown(row.error_worst[i], 'fraction')]
        ];
        causes.forEach(function(c) {
          if (row[c][i] > 0) rows.push([kit.causeLabel[c] || c, kit.shown(row[c][i], 'fraction'), c]);
        });
        kit.showTip(
            event, rows,
            row.resolution + ' texels of ' + metres(row.texel_m) + ', bias ' + metres(phase.bias_m[i]));
      });
      view.addEventListener('mouseout', kit.hideTip);
      view.addEventListener('click', function(event, item) {
        var d = item && item.datum;
        if (d && d.place) return choose(d.place);
        if (!d || d.row === undefined) return;
        tellCommand(d);
      });
    }
  };
});
// ---- by keyboard: the arrow keys go from cell to cell, Enter does what a click does
function nearest(list, v) {  // the place of the nearest value on a logarithmic axis; the ends stand for all beyond them
  var best = 0;
  list.forEach(function(other, i) {
    if (Math.abs(Math.log(v / other)) < Math.abs(Math.log(v / list[best]))) best = i;
  });
  return best;
}
// The rings of a cell. Each ring belongs to one cell, also those that are drawn on the end of an axis.
function ringsOf(cell) {
  var texels = phase.rows.map(function(r) {
    return r.texel_m;
  });
  return grid.places.filter(function(p) {
    var bias = Math.max(phase.bias_m[0], p.b);
    return nearest(texels, p.t) === cell.row && nearest(phase.bias_m, bias) === cell.bias;
  });
}
function wordsOf(cell) {
  var row = phase.rows[cell.row], i = cell.bias, b = phase.bias_m[i], out = '';
  out = row.resolution + ' texels of ' + metres(row.texel_m) + ', bias ' + metres(b) + ': ' +
      (row.usable && b >= row.usable[0] && b <= row.usable[1] ? 'usable' : 'not usable') + ', error ' +
      kit.shown(row.error[i], 'fraction') + ' in the mean, ' + kit.shown(row.error_worst[i], 'fraction') + ' at worst';
  causes.forEach(function(c) {
    if (row[c][i] > 0) out += ', ' + (kit.causeLabel[c] || c).toLowerCase() + ' ' + kit.shown(row[c][i], 'fraction');
  });
  ringsOf(cell).forEach(function(p) {
    out += (p.points.length > 1 ? '; points ' : '; point ') + p.points.join(', ');
  });
  return out + '.';
}
function keyboard() {
  var spoken = kit.make('p', {class: 'small spoken', 'aria-live': 'polite'}), frame = null;
  self.plot.after(spoken);
  self.plot.tabIndex = 0;
  self.plot.setAttribute('role', 'application');  // so that a screen reader passes the arrow keys on
  function show() {
    if (frame) frame.remove();
    var x = [cursor.bias, cursor.bias + 1].map(function(i) {
      return grid.x[i];
    }),
        y = [cursor.row, cursor.row + 1].map(function(j) {
          return grid.y[j];
        });
    frame = kit.make('div', {
      class: 'cursor',
      'aria-hidden': 'true',
      style: 'left:' + (grid.left + Math.min(x[0], x[1])) + 'px;top:' + (grid.top + Math.min(y[0], y[1])) +
          'px;width:' + Math.abs(x[1] - x[0]) + 'px;height:' + Math.abs(y[1] - y[0]) + 'px'
    });
    self.plot.append(frame);
    spoken.textContent = wordsOf(cursor);
  }
  self.plot.addEventListener('keydown', function(event) {
    var last = {row: phase.rows.length - 1, bias: phase.bias_m.length - 1};
    // Up is to coarser texels, as it is drawn.
    var up = phase.rows[0].texel_m < phase.rows[last.row].texel_m ? 1 : -1;
    var step = {ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [up, 0], ArrowDown: [-up, 0]}[event.key];
    if (event.key === 'Enter' && cursor) {
      var rings = ringsOf(cursor);
      if (rings.length)
        choose(rings[0]);
      else
        tellCommand(cursor);
    } else if (!step || !grid)
      return;
    else if (!cursor) {
      var first = grid.places[0];
      cursor = first ? {
        row: nearest(
            phase.rows.map(function(r) {
              return r.texel_m;
            }),
            first.t),
        bias: nearest(phase.bias_m, Math.max(phase.bias_m[0], first.b))
      } :
                       {row: 0, bias: 0};
      show();
    } else {
      cursor = {
        row: Math.max(0, Math.min(last.row, cursor.row + step[0])),
        bias: Math.max(0, Math.min(last.bias, cursor.bias + step[1]))
      };
      show();
    }
    event.preventDefault();
    event.stopPropagation();
  });
}
if (self) {
  self.plot.after(said);
  keyboard();
  said.append(
      'Click a cell for the command that renders it' + (places.length ? ', a ring for its points' : '') +
      '. By keyboard: the arrow keys go from cell to cell, Enter is the click.');
  var box = self.legend;
  function key(svg, text) {
    var e = kit.make('span');
    e.innerHTML = '<svg viewBox="0 0 26 10" aria-hidden="true">' + svg + '</svg>';
    e.append(text);
    box.append(e);
  }
  causes.forEach(function(c) {
    var there = phase.rows.some(function(row) {
      return row[c].some(function(v) {
        return v > 0;
      });
    });
    if (there) box.append(kit.make('span', {}, [kit.make('i', {class: 'sw c-' + c}), kit.causeLabel[c] || c]));
  });
  function stroke(colour, dash, width) {
    return '<line x1="0" x2="26" y1="5" y2="5" stroke="' + colour + '" stroke-width="' + width +
        '" stroke-dasharray="' + dash + '"/>';
  }
  key(stroke('var(--border-acne)', '1 0', 2.4), 'acne at its bound, worst placement');
  key(stroke('var(--border-acne)', '6 4', 1.5), 'acne, mean');
  key(stroke('var(--border-panning)', '1 0', 2.4), 'Peter Panning at its bound, worst placement');
  key(stroke('var(--border-panning)', '6 4', 1.5), 'Peter Panning, mean');
  if (kit.finite(phase.law_at_bound)) key(stroke('var(--ink)', '9 3 2 3', 1.3), 'law 1: acne at its bound');
  if (kit.finite(phase.law_steepest)) key(stroke('var(--ink)', '1.5 3.5', 1.3), 'law 1: the steepest lit plane');
  key('<path d="M2 10L12 0M10 10L20 0M18 10L26 2" stroke="var(--ink)" stroke-opacity=".6" fill="none"/>',
      'usable at every placement');
  if (places.length)
    key('<circle cx="13" cy="5" r="4" fill="none" stroke="var(--ink)" stroke-width="2"/>',
        'points of the sweep; the larger rings are several');
}
}
(page.data.phases || []).forEach(draw);
})();
