// The report's charts. Each is a function from the page's data block to a Vega specification, with a few controls.
// Colours are CSS variables, so light, dark and print need no redrawing.
(function() {
'use strict';
var data = noonmarkData;
// bias: 'set' or 'recommended' (bias_choice.js). select() marks a point everywhere; open() also opens its card (card.js).
var page = window.noonmarkPage = {data: data, selected: null, onSelect: [], bias: 'set', onBias: []};
if (data.points.some(function(p) {
      return p.at;
    }))
  page.bias = data.bias;
var thin = '\u202f';
var byId = {}, metricOf = {}, causeLabel = {};
data.points.forEach(function(p) {
  byId[p.id] = p;
});
data.metrics.forEach(function(m) {
  metricOf[m.name] = m;
});
data.causes.forEach(function(c) {
  causeLabel[c.name] = c.label;
});

// ---- small helpers
function make(tag, attributes, inner) {
  var e = document.createElement(tag);
  Object.keys(attributes || {}).forEach(function(k) {
    if (k === 'on')
      Object.keys(attributes.on).forEach(function(t) {
        e.addEventListener(t, attributes.on[t]);
      });
    else
      e.setAttribute(k, attributes[k]);
  });
  [].concat(inner === undefined ? [] : inner).forEach(function(c) {
    e.append(c);
  });
  return e;
}
function finite(v) {
  return typeof v === 'number' && isFinite(v);
}
// Groups of three digits from 10 000 on, as on the axes.
function grouped(text) {
  return text.replace(/^-?\d{5,}/, function(whole) {
    return whole.replace(/\B(?=(\d{3})+$)/g, thin);
  });
}
function digits(v) {
  if (!finite(v)) return 'not finite';
  if (v === 0) return '0';
  var a = Math.abs(v);
  if (a < 1e-4 || a >= 1e9)
    return String(+(v / Math.pow(10, Math.floor(Math.log10(a)))).toPrecision(3)) + '×10' +
        String(Math.floor(Math.log10(a))).replace(/./g, function(c) {
          return c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c];
        });
  if (a >= 1000) return grouped(String(a < 1e5 && v === Math.round(v) ? v : +v.toPrecision(4)));
  return String(+v.toPrecision(3));
}
function unitBehind(v, unit) {
  return v === 1 && unit === 'texels' ? 'texel' : unit;
}
function shown(v, unit) {
  // As cell() in report/text.cpp: less than 2^-50 of a share is the rounding of its sum.
  if ((unit === 'fraction' || !unit) && finite(v) && Math.abs(v) < Math.pow(2, -50)) v = 0;
  return !finite(v)       ? 'not finite' :
      unit === 'fraction' ? digits(100 * v) + thin + '%' :
      unit === 'bytes'    ? digits(1e-6 * v) + thin + 'MB' :
                            digits(v) + (unit && unit !== 'count' ? thin + unitBehind(v, unit) : '');
}
function value(point, measure) {
  var at = page.bias === 'recommended' && point.at && point.at.metrics;
  if (at && measure in at) return at[measure];
  return measure in point.metrics ? point.metrics[measure] : NaN;
}
// A value of a swept setting, with few digits. Points are matched by the value itself.
function valueText(swept, value) {
  var i = swept.values.indexOf(value);
  return i >= 0 ? swept.texts[i] : value;
}
// What distinguishes the point: with the bias as set, or with its recommended one in its place.
function phraseOf(p, mode) {
  if ((mode || page.bias) !== 'recommended' || !p.at || p.phrase_at_bias === undefined) return p.phrase || '';
  return (p.phrase_at_bias ? p.phrase_at_bias + ', ' : '') + p.at.parameter + ' ' + p.at.text;
}
function nameOf(p, mode) {
  var phrase = phraseOf(p, mode);
  return 'Point ' + p.id + (phrase ? ': ' + phrase : '');
}
// 'bias' or 'light-bleed reduction' (free_setting_words()) in the few letters of a label: 'Bias', 'Reduction', 'Bias, reduction'.
function freeLabel(words) {
  var label = words.replace('light-bleed ', '').replace(' or ', ', ');
  return label.charAt(0).toUpperCase() + label.slice(1);
}
function measureLabel(m) {
  return metricOf[m] ? metricOf[m].label : m;
}
function measureUnit(m) {
  return metricOf[m] ? metricOf[m].unit : '';
}
// Ticks of a logarithmic axis: powers of ten, and 2 and 5 between them if there is room.
function logTicks(low, high) {
  var decades = Math.log10(high / low),
      steps = decades < 0.4 ? [1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9] :
      decades < 1.2         ? [1, 1.5, 2, 3, 5, 7] :
      decades < 4           ? [1, 2, 5] :
                              [1],
      out = [];
  for (var e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e)
    steps.forEach(function(s) {
      var v = +(s * Math.pow(10, e)).toPrecision(3);
      if (v >= low * 0.999 && v <= high * 1.001) out.push(v);
    });
  return out;
}
// An expression of Vega for the labels of an axis: "0.5 %", "1.5 M", "16 384".
function axisLabel(unit) {
  if (unit === 'fraction') return 'format(datum.value * 100, \'~r\') + \'\u202f%\'';
  function scaled(power, letter) {
    return 'datum.value >= 1e' + power + ' ? format(datum.value / 1e' + power + ', \'~r\') + \'\u202f' + letter +
        '\' : ';
  }
  return scaled(9, 'G') + scaled(6, 'M') + 'datum.value >= 1e4 ? replace(format(datum.value, \',~r\'), ' +
      'regexp(\',\', \'g\'), \'\u202f\') : format(datum.value, \'~r\')';
}

var config = {
  background: 'transparent',
  axis: {
    domainColor: 'var(--faint)',
    tickColor: 'var(--faint)',
    gridColor: 'var(--grid)',
    labelColor: 'var(--soft)',
    titleColor: 'var(--soft)',
    labelFont: 'var(--sans)',
    titleFont: 'var(--sans)',
    labelFontSize: 12,
    titleFontSize: 12.5,
    titleFontWeight: 500,
    titlePadding: 9,
    labelPadding: 5,
    tickSize: 4
  },
  text: {font: 'var(--sans)', fontSize: 12, fill: 'var(--soft)'}
};

// ---- the tip
var tip = document.getElementById('tip');
function showTip(event, rows, title) {
  tip.textContent = '';
  if (title) tip.append(make('b', {}, title));
  tip.append(make('table', {}, rows.map(function(r) {
    var name = make('td', {}, r[2] ? [make('i', {class: 'sw c-' + r[2]}), r[0]] : r[0]);
    return make('tr', {}, [name, make('td', {}, r[1])]);
  })));
  tip.hidden = false;
  var w = tip.offsetWidth, h = tip.offsetHeight, x = event.clientX + 16, y = event.clientY + 14;
  if (x + w > innerWidth - 8) x = event.clientX - w - 14;
  tip.style.left = Math.max(8, x) + 'px';
  tip.style.top = Math.min(y, innerHeight - h - 8) + 'px';
}
function hideTip() {
  tip.hidden = true;
}
// The tip as a sentence.
function tipWords() {
  var title = tip.querySelector('b'), rows = Array.prototype.map.call(tip.querySelectorAll('tr'), function(row) {
    return Array.prototype.map
        .call(
            row.cells,
            function(cell) {
              return cell.textContent;
            })
        .join(' ');
  });
  return (title ? title.textContent + ': ' : '') + rows.join('; ') + '.';
}

page.open = page.redraw = function() {};
page.select = function(id) {
  if (!byId[id]) return;
  page.selected = id;
  page.onSelect.forEach(function(f) {
    f(id);
  });
};

// ---- drawing and redrawing
var drawn = [];
function chart(id, build) {
  var figure = document.getElementById('chart-' + id);
  if (!figure) return null;
  var plot = figure.querySelector('.plot'), view = null;
  var self = {
    figure: figure,
    controls: figure.querySelector('.controls'),
    legend: figure.querySelector('.legend'),
    plot: plot,
    draw: function() {
      if (view) view.finalize();
      plot.textContent = '';
      var built = build(Math.max(260, plot.clientWidth), self);
      if (!built) return;
      built.spec.config = config;
      // The plot has one name, and a table beside it has its numbers; Vega's names of each group of marks are hidden.
      var drawing = make('div', {'aria-hidden': 'true'});
      plot.append(drawing);
      view = noonmarkVega.draw(built.spec, drawing);
      self.view = view;
      view.addEventListener('mousemove', function(event, item) {
        var d = item && item.datum;
        if (d && d.id !== undefined)
          built.tip ? built.tip(event, d) : pointTip(event, d, built.measure);
        else if (!built.hover)
          hideTip();
        plot.style.cursor = d && d.id !== undefined ? 'pointer' : '';
      });
      view.addEventListener('mouseout', hideTip);
      view.addEventListener('click', function(event, item) {
        if (item && item.datum && item.datum.id !== undefined) page.open(item.datum.id);
      });
      if (built.hover) built.hover(view, plot);
    }
  };
  drawn.push(self);
  return self;
}
function pointTip(event, d, measure) {
  var p = byId[d.id], rows = [[measureLabel(measure), shown(value(p, measure), measureUnit(measure))]];
  ['error', 'acne', 'peter_panning', 'aliasing_dark', 'aliasing_light', data.cost].forEach(function(m) {
    if (m !== measure && m in p.metrics)
      rows.push([measureLabel(m), shown(value(p, m), measureUnit(m)), m === 'error' || m === data.cost ? '' : m]);
  });
  showTip(event, rows, nameOf(p));
}
function picker(label, options, chosen, changed) {
  var select = make(
      'select', {
        on: {
          change: function() {
            changed(select.value);
          }
        }
      },
      options.map(function(o) {
        var option = make('option', {value: o[0]}, o[1]);
        if (String(o[0]) === String(chosen)) option.selected = true;
        return option;
      }));
  return make('label', {}, [label, select]);
}
// Chooses one of the points by its part and by what distinguishes it.
function pointPicker(points, chosen) {
  return picker(
      'Point', points.map(function(p) {
        return [p.id, [p.part, p.phrase].filter(Boolean).join(': ') || 'Point ' + p.id];
      }),
      chosen, function(v) {
        page.select(+v);
      });
}
function segments(options, chosen, changed) {
  var box = make('span', {class: 'segments'});
  options.forEach(function(o) {
    box.append(make(
        'button', {
          type: 'button',
          'aria-pressed': String(o[0] === chosen),
          on: {
            click: function() {
              box.querySelectorAll('button').forEach(function(b) {
                b.setAttribute('aria-pressed', String(b.textContent === o[1]));
              });
              changed(o[0]);
            }
          }
        },
        o[1]));
  });
  return box;
}

// A logarithmic axis cannot show zeros. They are drawn hollow, on a line below the least positive value.
function logFloor(values) {
  var positive = values.filter(function(v) {
    return v > 0;
  });
  if (!positive.length) return null;
  var low = Math.min.apply(null, positive), high = Math.max.apply(null, positive),
      zeros = positive.length < values.length;
  return {low: zeros ? low / 2.2 : low / 1.25, high: high * 1.25, zero: zeros ? low / 2.2 : null};
}

// The scale, the axis and the label of zero of a chart whose values were given to logFloor.
function measureScale(floor, height) {
  return {name: 'y', type: 'log', zero: false, domain: [floor.low, floor.high], range: [height, 0]};
}
// No value is labelled at the place where zeros are drawn, because a zero would look like that value.
function measureAxis(floor, measure) {
  var unit = measureUnit(measure);  // labels have that of a fraction
  return {
    orient: 'left',
    scale: 'y',
    grid: true,
    domain: false,
    ticks: false,
    values: logTicks(floor.zero ? floor.low * 1.6 : floor.low, floor.high),
    title: measureLabel(measure) + (unit && unit !== 'fraction' && unit !== 'count' ? ' (' + unit + ')' : ''),
    encode: {labels: {update: {text: {signal: axisLabel(unit)}}}}
  };
}
// The list of marks is empty if no value is zero.
function zeroLabel(floor) {
  if (!floor.zero) return [];
  return [{
    type: 'text',
    encode: {
      enter: {
        x: {value: -10},
        y: {scale: 'y', value: floor.zero},
        align: {value: 'right'},
        baseline: {value: 'middle'},
        text: {value: '0'}
      }
    }
  }];
}

// The usable reductions of a point, at every placement of the grid if it has several; null: none, or not known (no_window).
function windowOfReduction(point) {
  var placed = point.metrics.error_mean !== undefined, ending = placed ? '_worst' : '',
      from = point.metrics['reduction_min' + ending], to = point.metrics['reduction_max' + ending];
  return !point.no_window && finite(from) && finite(to) ? {from: from, to: to, placed: placed} : null;
}

page.kit = {
  freeLabel: freeLabel,
  windowOfReduction: windowOfReduction,
  make: make,
  finite: finite,
  digits: digits,
  shown: shown,
  value: value,
  nameOf: nameOf,
  valueText: valueText,
  measureLabel: measureLabel,
  measureUnit: measureUnit,
  logTicks: logTicks,
  axisLabel: axisLabel,
  showTip: showTip,
  hideTip: hideTip,
  tipWords: tipWords,
  chart: chart,
  picker: picker,
  pointPicker: pointPicker,
  segments: segments,
  logFloor: logFloor,
  measureScale: measureScale,
  measureAxis: measureAxis,
  zeroLabel: zeroLabel,
  causeLabel: causeLabel,
  byId: byId,
  drawn: drawn
};
})();
