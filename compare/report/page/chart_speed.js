// Cost against error: one mark for each choice at its best bias, a curve for each technique, the Pareto front and the three
// answers. compare/report/speed_reading.h finds all of these; the page draws them.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, data = page.data, speed = data.speed;
var shapes = kit.speed.shapes;
if (!speed.groups.length || !speed.costs.length || !speed.errors.length) return;
// The colours of the techniques that err least somewhere, in the order of their costs; the others are grey.
var colours = ['var(--q0)', 'var(--q3)', 'var(--q6)', 'var(--c-peter_panning)', 'var(--q1)', 'var(--q4)'];
var state = {group: speed.group, cost: speed.costs[0], error: speed.error, property: 0, id: null};

function group() {
  return speed.groups[state.group];
}
// What is read off the chosen cost and error.
function reading() {
  var of = (group().readings[state.cost] || {})[state.error];
  return of ? of[page.bias === 'recommended' ? 'best' : 'set'] : {front: [], ahead: [], words: []};
}
function isBytes() {
  return kit.measureUnit(state.cost) === 'bytes';
}
// The error of a choice at the bias that the reader chose for the page.
function errorOf(entry) {
  var of = entry.errors[state.error];
  if (page.bias === 'recommended' || entry.window === 'no_curve' || !of.at_bias) return of;
  return {v: of.set, span: of.span, counts: of.set_counts, at_bias: false};
}
// At its own bias a choice is not named after the bias as set.
function nameOf(entry) {
  return page.bias === 'set' ? entry.name : entry.name_at_bias || entry.name;
}
function causeOf(entry) {
  return page.bias === 'set' ? entry.set_cause : entry.cause;
}
// 'bias' or 'light-bleed reduction'
function wordOf(entry) {
  return (kit.byId[entry.id].at || {word: data.free}).word;
}
function windowText(entry) {
  return entry.window === 'unknown' ? 'not known, because too much is ambiguous' :
      entry.window === 'empty' ? 'none: no ' + wordOf(entry) + ' is good enough' :
      entry.window === 'no_curve' ? 'no curve over a bias or a reduction' :
                                    entry.bias.from + ' … ' + entry.bias.to;
}

function inUnit(cost) {
  return cost * (isBytes() ? 1e-6 : 1);
}
// "4.1 ms (3.9 … 4.4)"
function costText(cost) {
  var unit = kit.measureUnit(state.cost);
  return kit.shown(cost[0], unit) +
      (cost.length > 2 ? ' (' + kit.shown(cost[2], unit) + ' … ' + kit.shown(cost[3], unit) + ')' : '');
}

function colourOf(technique) {
  var at = reading().ahead.indexOf(technique);
  return at < 0 ? 'var(--faint)' : colours[at % colours.length];
}
// The drawn choices of the group, with x and y in the units of the axes. low and high: the interval of a measured cost.
function rowsOf(entries) {
  var property = group().properties[state.property], read = reading(), answers = read.answers || {};
  return entries
      .map(function(entry, i) {
        var of = errorOf(entry), value = property ? entry.is[state.property] : 0;
        var cost = entry.costs[state.cost], ahead = read.ahead.indexOf(entry.technique) >= 0;
        var names = ['least', 'balanced', 'best'].filter(function(name) {
          return answers[name] === i;
        });
        var strong = ahead || names.length > 0 || entry.id === state.id || read.front.indexOf(i) >= 0;
        return {
          id: entry.id,
          index: i,
          entry: entry,
          ahead: ahead,
          answer: names.join(', '),
          strong: strong,
          counted: strong || !group().scale,  // along curves the numbers of equal marks would hide them
          size: strong ? 90 : 36,
          x: inUnit(cost[0]),
          low: inUnit(cost.length > 2 ? cost[2] : cost[0]),
          high: inUnit(cost.length > 2 ? cost[3] : cost[0]),
          v: of.v[0],
          ok: kit.finite(cost[0]) && kit.finite(of.v[0]),
          counts: of.counts,
          held: entry.judged,
          span: of.span && kit.finite(of.span[0]) && kit.finite(of.span[1]) ? of.span : null,
          // Blur by design is hollow, so that it does not depend on the grey alone.
          fill: causeOf(entry) === 'filter' ? 'var(--card)' :
              causeOf(entry)                ? 'var(--c-' + causeOf(entry) + ')' :
                                              'var(--grid)',
          shape: !of.counts         ? kit.speed.cross :
              value < shapes.length ? shapes[value] :
                                      kit.speed.disc,
          number: of.counts && value >= shapes.length ? String(value + 1) : ''
        };
      })
      .filter(function(r) {
        return r.ok;
      });
}
// The rows of the entries, in their order. Those without finite values are left out.
function rowsAt(rows, indices) {
  return indices
      .map(function(i) {
        return rows.filter(function(r) {
          return r.index === i;
        })[0];
      })
      .filter(Boolean);
}

// From the least to the largest error of what was tried: the choices of the row's technique that cost the same differ only in
// what tunes it. Null if there is one.
function tunedSpan(rows, row) {
  var same = rows.filter(function(r) {
    return r.entry.technique === row.entry.technique && r.x === row.x && r.counts;
  });
  if (same.length < 2) return null;
  return [Math.min.apply(null, same.map(errorIn)), Math.max.apply(null, same.map(errorIn))];
}
function errorIn(row) {
  return row.v;
}

function tip(event, row) {
  var e = row.entry, of = errorOf(e), cost = e.costs[state.cost], many = e.conditions > 1;
  function both(v, measure) {
    var unit = kit.measureUnit(measure);
    return kit.shown(v[0], unit) + (many ? ' (mean ' + kit.shown(v[1], unit) + ')' : '');
  }
  var unit = kit.measureUnit(state.error), rows = [
    [
      kit.measureLabel(state.cost),
      costText(cost) + (many ? ' (mean ' + kit.shown(cost[1], kit.measureUnit(state.cost)) + ')' : '')
    ],
    [kit.measureLabel(state.error), both(of.v, state.error)]
  ];
  if (row.span)
    rows.push(['over the usable window', kit.shown(of.span[0], unit) + ' … ' + kit.shown(of.span[1], unit)]);
  if (e.window !== 'no_curve')
    rows.push([of.at_bias ? 'at ' + e.bias.parameter : 'best ' + e.bias.parameter, e.bias.value]);
  rows.push(['usable window', windowText(e)]);
  if (!of.at_bias)
    rows.push(['this error', e.window === 'no_curve' ? 'as rendered' : 'with the ' + wordOf(e) + ' as rendered']);
  var cause = causeOf(e);
  if (cause) rows.push(['largest cause', kit.causeLabel[cause] || cause, cause]);
  rows.push(['good enough', e.good ? 'yes' : e.judged ? 'no' : 'not known: held to no bound']);
  if (many) rows.push(['conditions', String(e.conditions)]);
  if (row.answer) rows.push(['answer', row.answer]);
  if (row.others.length)
    rows.push(['here too', row.others.slice(0, 6).map(name).join('; ') + (row.others.length > 6 ? ' …' : '')]);
  kit.showTip(event, rows, nameOf(e));
}
function name(row) {
  return nameOf(row.entry);
}

var shownRows = [], shownMarks = [];
var self = kit.chart('cost', function(width) {
  var g = group(), read = reading(), curves = g.curves[read.curves] || [];
  var wide = width >= 680 && g.scale !== '';
  var left = 64, right = wide ? kit.speed.roomFor(g.techniques) : 12;
  var w = width - left - right, height = width < 520 ? 320 : 420;
  var entries = g.entries, rows = rowsOf(entries), all = [];
  shownRows = rows;
  rows.forEach(function(r) {
    all = all.concat([r.v], (r.ahead || r.entry === described()) && r.span || []);
  });
  var floor = kit.logFloor(all);
  self.plot.textContent = '';
  shownMarks = [];
  if (!rows.length || !floor) {
    tell(rows, entries.length - rows.length);
    self.plot.append(kit.make(
        'p', {class: 'small'}, rows.length ? 'The value is 0 at every choice.' : 'No choice has finite values.'));
    return null;
  }
  function height_of(v) {
    return v > 0 ? v : floor.zero;
  }
  var x = kit.speed.place(rows, w);
  rows.forEach(function(r) {
    r.y = height_of(r.v);
    if (r.span) r.bottom = height_of(r.span[0]), r.top = height_of(r.span[1]);
  });
  var front = rowsAt(rows, read.front), last = front[front.length - 1];
  function rank(r) {
    return r.id === state.id ? 0 : r.answer ? 1 : front.indexOf(r) >= 0 ? 2 : r.counts ? 3 : 4;
  }
  function before(a, b) {
    return rank(a) - rank(b) || a.v - b.v;
  }
  function pixels(r) {
    return height * Math.log(floor.high / r.y) / Math.log(floor.high / floor.low);
  }
  var marks = shownMarks = kit.speed.together(rows, pixels, before);
  function only(test) {
    return rows.filter(test);
  }
  var lines = [], ends = [];
  curves.forEach(function(curve, technique) {
    var drawn = rowsAt(rows, curve);
    if (drawn.length < 2) return;
    drawn.forEach(function(r) {
      lines.push({technique: technique, ahead: r.ahead, colour: colourOf(technique), px: r.px, y: r.y});
    });
    var end = drawn[drawn.length - 1];
    ends.push(
        {text: g.techniques[technique], must: end.ahead, colour: colourOf(technique), at: pixels(end), from: end.px});
  });
  // A curve that ends far from the edge has its name at its end; a line to the edge would cross the others. A letter of bold text
  // has some 8 pixels.
  function endsInside(label) {
    return label.from + 20 + 8 * label.text.length < w;
  }
  // The bars: of the described choice, and along the curves that err least somewhere, so that they hide nothing else.
  var bars = rows.filter(function(r) {
    r.colour = 'var(--soft)';
    return r.span && r.entry === described();
  });
  curves.forEach(function(curve, technique) {
    rowsAt(rows, curve).forEach(function(r) {
      if (!r.ahead || bars.indexOf(r) >= 0) return;
      var tuned = tunedSpan(rows, r);
      if (!r.span && !tuned) return;
      bars.push({
        px: r.px,
        bottom: r.span ? r.bottom : height_of(tuned[0]),
        top: r.span ? r.top : height_of(tuned[1]),
        colour: colourOf(technique)
      });
    });
  });
  lines.sort(function(a, b) {
    return a.ahead - b.ahead;  // those that err least somewhere lie above the others
  });
  tell(rows, entries.length - rows.length);
  return {
    tip: tip,
    spec: {
      width: w,
      height: height,
      padding: {left: left, right: right, top: 10, bottom: 46},
      autosize: 'none',
      data: [
        {name: 'rows', values: marks}, {name: 'spans', values: bars}, {
          name: 'intervals',
          values: only(function(r) {
            return r.high > r.low;
          })
        },
        {name: 'curves', values: lines}, {
          name: 'labels',
          values: wide ? kit.speed.spread(
                             ends.filter(function(label) {
                               return !endsInside(label);
                             }),
                             height) :
                         []
        },
        {name: 'ends', values: wide ? ends.filter(endsInside) : []},
        {name: 'front', values: last ? front.concat([{px: w, y: last.y}]) : []}, {
          name: 'answers',
          values: only(function(r) {
            return r.answer;
          })
        },
        {
          name: 'chosen',
          values: only(function(r) {
            return r.id === state.id;
          })
        }
      ],
      scales: [x, kit.measureScale(floor, height)],
      axes: [
        kit.measureAxis(floor, state.error), {
          orient: 'bottom',
          scale: 'x',
          values: x.type === 'log' ? kit.speed.ticks(x, w) : undefined,
          labelOverlap: true,
          title: kit.measureLabel(state.cost) + ' (' +
              (isBytes()                                   ? 'MB' :
                   kit.measureUnit(state.cost) === 'count' ? 'number' :
                                                             kit.measureUnit(state.cost)) +
              ')',
          encode: {labels: {update: {text: {signal: kit.axisLabel('')}}}}
        }
      ],
      marks: kit.speed.marksOf(w, floor, right)
    }
  };
});
if (!self) return;

// ---- around the chart: what it says in words, its legend, the picture of a choice
var words = kit.make('p', {class: 'facts', 'aria-live': 'polite'}), side = kit.make('figure', {class: 'beside'}),
    notes = kit.make('p', {class: 'small'}), takeovers = kit.make('p', {class: 'takeovers'});
self.plot.after(takeovers, words);
self.plot.before(notes);
self.plot.before(side);

function describe(entry) {
  var of = errorOf(entry);
  return [
    kit.make('a', {href: '#p' + entry.id}, nameOf(entry)),
    ': ' + costText(entry.costs[state.cost]) + ', ' + kit.measureLabel(state.error).toLowerCase() + ' ' +
        kit.shown(of.v[0], kit.measureUnit(state.error)) +
        (of.at_bias ? ' at ' + entry.bias.parameter + ' ' + entry.bias.value : ' as rendered') +
        '; usable window: ' + windowText(entry) + '.'
  ];
}
function entryOf(id) {
  return group().entries.filter(function(e) {
    return e.points.indexOf(id) >= 0;
  })[0];
}
// The choice whose picture is shown: the selected one, otherwise the balanced one.
function described() {
  var answers = reading().answers;
  return entryOf(state.id) || (answers && group().entries[answers.balanced]);
}
// The picture first, because it takes width from the plot.
function redraw() {
  picture(described());
  self.draw();
}
// Each answer, those that are the same choice together: [["Least, balanced", entry], ["Best", entry]].
function answersOf() {
  var found = [], answers = reading().answers || {};
  ['least', 'balanced', 'best'].forEach(function(name) {
    if (answers[name] === undefined) return;
    var entry = group().entries[answers[name]], same = found[found.length - 1];
    if (same && same[1] === entry)
      same[0] += ', ' + name;
    else
      found.push([name, entry]);
  });
  return found;
}
function tell(rows, missing) {
  var g = group(), chosen = entryOf(state.id), read = reading(), text = [];
  if (g.entries.length < g.choices)
    text.push(g.entries.length + ' of ' + g.choices + ' choices are drawn; front and answers are of all.');
  if (read.curves === undefined)
    text.push('Of so many choices only the cost and the error of the beginning have curves, front and answers.');
  if (missing) text.push(missing + ' not finite, left out.');
  var rendered = rows.filter(function(r) {
    return r.entry.window !== 'no_curve' && !errorOf(r.entry).at_bias;
  });
  if (rendered.length && page.bias === 'set')
    text.push('Each choice is at the ' + data.free + ' as set; those outside their usable window are crosses.');
  else if (rendered.length)
    text.push(
        'No curve over the ' + data.free +
        ' gives this error of the choices, so it is as rendered. Choices rendered outside their usable window are crosses.');
  if (rows.some(function(r) {
        return r.high > r.low;
      }))
    text.push(
        'Each time is a median. The bar along the cost holds it with 96 %: costs whose bars overlap count as equal, for the front too.');
  notes.textContent = text.join(' ');
  takeovers.textContent = '';
  read.words.forEach(function(phrase) {
    takeovers.append(typeof phrase === 'string' ? phrase : kit.make('b', {}, phrase[0]));
  });
  words.textContent = '';
  answersOf().forEach(function(answer, i) {
    var name = answer[0].charAt(0).toUpperCase() + answer[0].slice(1);
    words.append.apply(words, [i ? kit.make('br') : '', kit.make('b', {}, name), ': '].concat(describe(answer[1])));
  });
  if (!chosen) return;
  words.append.apply(
      words, [words.firstChild ? kit.make('br') : '', kit.make('b', {}, 'Selected'), ': '].concat(describe(chosen)));
  // The choices that share its mark, because a pointer cannot tell them apart.
  var mark = shownMarks.filter(function(m) {
    return m.entry === chosen;
  })[0];
  if (!mark || !mark.others.length) return;
  words.append(' At the same cost with nearly the same error: ');
  mark.others.forEach(function(r, i) {
    words.append(i ? '; ' : '', kit.make('a', {href: '#p' + r.id}, nameOf(r.entry)));
  });
  words.append('.');
}
// The picture that the page has of one of the choice's points.
function picture(entry) {
  side.textContent = '';
  var found = null;
  ((entry && entry.points) || []).some(function(id) {
    return ['shaded', 'classes', 'map', 'truth'].some(function(name) {
      found = document.querySelector('.pictures[data-point="' + id + '"] figure[data-name="' + name + '"] img');
      return found;
    });
  });
  if (found) side.append(kit.make('img', {src: found.src, alt: found.alt}), kit.make('figcaption', {}, found.alt));
}

function symbol(inner, text) {
  var e = kit.make('span');
  e.innerHTML = '<svg viewBox="0 0 26 12" aria-hidden="true">' + inner + '</svg>';
  e.append(text);
  self.legend.append(e);
}
function path(d, fill, stroke) {
  return '<path d="' + d + '" transform="translate(13 6) scale(5)" fill="' + fill + '" stroke="' + stroke +
      '" stroke-width=".22"/>';
}
function legend() {
  self.legend.textContent = '';
  var g = group(), property = g.properties[state.property], causes = {};
  g.entries.forEach(function(e) {
    if (causeOf(e)) causes[causeOf(e)] = true;
  });
  self.legend.append(kit.make('span', {class: 'title'}, 'Largest cause'));
  Object.keys(causes).forEach(function(c) {
    symbol(
        path(shapes[0], c === 'filter' ? 'var(--card)' : 'var(--c-' + c + ')', 'var(--ink)'), kit.causeLabel[c] || c);
  });
  if (property) {
    self.legend.append(kit.make('span', {class: 'title'}, property.label));
    property.values.forEach(function(v, i) {
      if (i < shapes.length)
        symbol(path(shapes[i], 'var(--soft)', 'none'), v);
      else
        symbol(
            '<text x="13" y="9.5" text-anchor="middle" font-size="10" font-weight="700" fill="var(--ink)">' + (i + 1) +
                '</text>',
            v);
    });
  }
  function line(more, text) {
    symbol('<line x1="0" x2="26" y1="6" y2="6" ' + more + '/>', text);
  }
  if (g.scale) {
    self.legend.append(kit.make('span', {class: 'title'}, 'Over ' + g.scale + ': least error at some cost'));
    reading().ahead.forEach(function(technique) {
      line('stroke="' + colourOf(technique) + '" stroke-width="2.4"', g.techniques[technique] || 'all choices');
    });
    line('stroke="var(--faint)"', 'another technique');
  }
  self.legend.append(kit.make('span', {class: 'title'}, 'Marks'));
  line('stroke="var(--accent)" stroke-width="1.6" stroke-dasharray="2 3"', 'Pareto front');
  symbol(path(kit.speed.cross, 'none', 'var(--bad)'), 'at no usable ' + data.free);
  if (g.entries.some(function(entry) {
        return !entry.judged;
      }))
    symbol(
        '<circle cx="13" cy="6" r="5" fill="none" stroke="var(--ink)" stroke-width="1.6" stroke-dasharray="2 2"/>',
        'as set, held to no bound');
  symbol(
      '<line x1="13" x2="13" y1="0" y2="12" stroke="var(--soft)" stroke-width="1.6"/>',
      'over the usable window, or what was tried');
  symbol(
      '<circle cx="6" cy="6" r="4" fill="var(--grid)" stroke="var(--ink)"/><text x="12" y="9.5" font-size="10" fill="var(--soft)">+2</text>',
      'several at one place');
  if (g.entries.some(function(e) {
        return e.costs[state.cost].length > 2;
      }))
    line('stroke="var(--soft)" stroke-width="1.6"', 'interval of the time');
  if (reading().answers)
    symbol('<circle cx="13" cy="6" r="5" fill="none" stroke="var(--good)" stroke-width="1.8"/>', 'answer');
}

function controls() {
  self.controls.textContent = '';
  function add(label, options, chosen, key, number) {
    if (options.length < 2) return;
    self.controls.append(kit.picker(label, options, chosen, function(v) {
      state[key] = number ? +v : v;
      if (key === 'group') state.property = 0;
      if (key === 'group') controls();
      legend();
      redraw();
    }));
  }
  function named(m) {
    return [m, kit.measureLabel(m)];
  }
  function numbered(list, text) {
    return list.map(function(one, i) {
      return [i, text(one)];
    });
  }
  add('Compare', numbered(speed.groups, function(g) {
        return g.name + ' (' + g.choices + ')';
      }), state.group, 'group', true);
  add('Cost', speed.costs.map(named), state.cost, 'cost');
  add('Error', speed.errors.map(named), state.error, 'error');
  add('Shape', numbered(group().properties, function(p) {
        return p.label;
      }), state.property, 'property', true);
}
controls();
legend();
picture(described());

page.onSelect.push(function(id) {
  var entry = entryOf(id);
  state.id = entry ? entry.id : null;
  redraw();
});
page.onBias.push(function() {
  legend();
  picture(described());
});
// The arrow keys go from mark to mark, from left to right.
self.plot.tabIndex = 0;
self.plot.addEventListener('keydown', function(event) {
  if (event.key === 'Enter' && described()) page.open(described().id);
  var way = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
  if (!way || !shownRows.length) return;
  var order = shownRows.slice().sort(function(a, b) {
    return a.px - b.px || a.v - b.v;
  }),
      at = order.findIndex(function(r) {
        return r.entry === described();
      });
  page.select(order[Math.min(order.length - 1, Math.max(0, at + way))].id);
  event.preventDefault();
  event.stopPropagation();
});
})();
