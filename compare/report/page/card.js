// The card of one point: its pictures with a wipe and a zoom, its worst pixel, all its numbers, and its command. Every
// link to a point, and every click on a mark, a row or a bar, opens it.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, make = kit.make, data = page.data;
// bias: 'set' where the card shows a broken bound, which was judged with the bias as set; null: that of the page.
var state = {left: 'truth', right: 'classes', divide: 50, zoom: 1, worst: 'error', bias: null};
// A frame of another renderer has no bias of ours.
var asSet = data.frames ? '.' : ', with the ' + data.free + ' as set.';
function mode() {
  return state.bias || page.bias;
}
var title = make('h2', {id: 'card-title', tabindex: '-1'}), inner = make('div', {class: 'card-inner'});
function button(label, act, more) {
  return make('button', Object.assign({type: 'button', on: {click: act}}, more || {}), label);
}
function step(by) {
  var at = data.points.indexOf(kit.byId[page.selected]), next = data.points[at + by];
  if (next) page.open(next.id);
}
var card = make('dialog', {id: 'card', 'aria-labelledby': 'card-title'}, [
  make(
      'div', {class: 'card-head'},
      [
        title,
        make(
            'div', {class: 'controls'},
            [
              button(
                  'Previous',
                  function() {
                    step(-1);
                  }),
              button(
                  'Next',
                  function() {
                    step(1);
                  }),
              button(
                  'Close',
                  function() {
                    card.close();
                  })
            ])
      ]),
  inner
]);
document.body.append(card);

// The pictures that the page has of a point. Of the point of the live picture those at the recommended bias too: in full size
// if they were measured, otherwise from the live picture.
function picturesOf(p) {
  var out = Array.prototype.slice.call(document.querySelectorAll('.pictures[data-point="' + p.id + '"] figure'))
                .map(function(f) {
                  var img = f.querySelector('img');
                  return img && {name: f.dataset.name, src: img.src, alt: img.alt, element: img};
                })
                .filter(Boolean);
  var live = page.live;
  if (live && live.data.point === p.id && p.at && live.has(p.at) && !named(out, 'map as recommended'))
    [['truth', 'truth'], ['map', 'map'], ['causes', 'classes']].forEach(function(k) {
      out.push({
        name: k[1] + ' as recommended',
        src: live.pictureAt(p.at.depth, k[0]),
        alt: k[1] + ' as recommended, from the live picture'
      });
    });
  return out;
}
function named(list, name) {
  return list.filter(function(x) {
    return x.name === name;
  })[0];
}

function labelOf(metric) {
  return kit.causeLabel[metric] || kit.measureLabel(metric);
}
function failureOf(p) {
  return (p.failures || []).filter(function(f) {
    return f.metric === state.worst && f.x !== undefined;
  })[0];
}
// Where the worst pixel is: with the bias as set as the record says, at the recommended one in the live picture.
function worstOf(p) {
  var live = page.live && page.live.data.point === p.id && page.live;
  if (mode() === 'recommended' && p.at && live && live.has(p.at)) {
    var found = live.worst(state.worst, p.at.depth);
    return found && {
      live: true,
      x: found.x,
      y: found.y,
      text: 'Wrong by ' + kit.shown(found.error, 'fraction') + ', ' + labelOf(found.cause) +
          ', in the live picture at the recommended ' + p.at.word + '.'
    };
  }
  var failure = failureOf(p);
  if (failure)
    return {x: failure.x, y: failure.y, text: failure.label + ' ' + failure.size + ' there' + asSet};
  if (state.worst === 'error')
    return p.worst && {
      x: p.worst.x,
      y: p.worst.y,
      text: 'Wrong by ' + kit.shown(Number(p.worst.error), 'fraction') +
          (p.worst.cause ? ', ' + labelOf(p.worst.cause) : '') + asSet
    };
  var of = (p.worst_of || {})[state.worst];
  return of && {
    x: of.x,
    y: of.y,
    text: labelOf(state.worst) + ' ' + kit.shown(Number(of.size), 'fraction') + ' there' + asSet
  };
}
// What the worst pixel can be worst of, with a label for each.
function worstChoices(p) {
  var names = ['error'].concat(
      (p.failures || [])
          .filter(function(f) {
            return f.x !== undefined;
          })
          .map(function(f) {
            return f.metric;
          }),
      data.metrics
          .map(function(m) {
            return m.name;
          })
          .filter(function(name) {
            return p.worst_of && name in p.worst_of;
          }));
  if (mode() === 'recommended' && p.at && page.live && page.live.data.point === p.id && page.live.has(p.at))
    names = ['error'].concat(page.live.data.causes.slice(1));
  return names
      .filter(function(name, i) {
        return names.indexOf(name) === i;
      })
      .map(function(name) {
        return [name, name === 'error' ? 'error' : labelOf(name)];
      });
}

function stage(p) {
  var list = picturesOf(p), box = make('section', {class: 'card-pictures', 'aria-label': 'Pictures'});
  if (!list.length) {
    box.append(make(
        'p', {class: 'missing'},
        'No picture of this point was kept. The command below renders it; pictures = "all" in the experiment keeps those of every point.'));
    return box;
  }
  var follow = mode() === 'recommended' && named(list, 'map as recommended') ? ' as recommended' : '';
  if (mode() === 'recommended' && p.at)
    box.append(make(
        'p', {class: 'small'},
        follow ? 'The pictures at the recommended ' + p.at.word + ' have that in their names; the others are as set.' :
                 'These pictures are of the ' + p.at.word + ' as set. None was measured at the recommended one.'));
  var left = named(list, state.left + follow) || named(list, state.left) || list[0],
      right = named(list, state.right + follow) || named(list, state.right) || list[list.length - 1];
  function options() {
    return list.map(function(x, i) {
      return [x.name, (i < 9 ? i + 1 + ' ' : '') + x.name];
    });
  }
  function pick(side) {
    return function(name) {
      state[side] = name;
      if (side === 'left')
        left = named(list, name);
      else
        right = named(list, name);
      show();
    };
  }
  var a = make('img'), b = make('img'), line = make('i', {class: 'line'}), ring = make('i', {class: 'ring'}),
      wide = make('div', {class: 'wide'}, [a, b, line, ring]),
      view =
          make('div', {class: 'wipe', tabindex: '0', role: 'region', 'aria-label': 'Pictures, left and right'}, wide),
      cuts = make('div', {class: 'cuts'}), said = make('p', {class: 'small', role: 'status'});
  var divide = make('input', {type: 'range', min: 0, max: 100, step: 1, value: state.divide});
  divide.addEventListener('input', function() {
    state.divide = +divide.value;
    show();
  });
  function zoom(by) {
    state.zoom = Math.max(1, Math.min(16, state.zoom * by));
    show();
    if (ring.style.left && by > 1) {  // the worst pixel stays in view
      view.scrollLeft = parseFloat(ring.style.left) / 100 * wide.clientWidth - view.clientWidth / 2;
      view.scrollTop = parseFloat(ring.style.top) / 100 * wide.clientHeight - view.clientHeight / 2;
    }
  }
  function show() {
    [[a, left], [b, right]].forEach(function(x) {
      x[0].src = x[1].src;
      x[0].alt = x[1].alt;
    });
    b.style.clipPath = 'inset(0 0 0 ' + state.divide + '%)';
    line.style.left = state.divide + '%';
    wide.style.width = 100 * state.zoom + '%';
    mark();
  }
  function mark() {
    // The record counts pixels of the point's own pictures.
    var own = list.filter(function(q) {
      return q.element;
    })[0];
    var w = worstOf(p),
        size = w && w.live ? page.live.data :
        own                ? {width: own.element.naturalWidth, height: own.element.naturalHeight} :
                             {};
    cuts.textContent = '';
    said.textContent = w ? w.text : 'No pixel is wrong by this.';
    ring.hidden = !w || !size.width;
    if (ring.hidden) return;
    var x = (w.x + 0.5) / size.width, y = (w.y + 0.5) / size.height;
    ring.style.left = 100 * x + '%';
    ring.style.top = 100 * y + '%';
    said.textContent = 'Worst pixel (' + w.x + ', ' + w.y + ') from the top left. ' + w.text;
    [left, right]
        .concat(list.filter(function(q) {
          return ['truth' + follow, 'map' + follow, 'frame', 'classes' + follow, 'causes'].indexOf(q.name) >= 0 && q !== left &&
              q !== right;
        }))
        .slice(0, 4)
        .forEach(function(q) {
          cuts.append(cut(q, x, y));
        });
    var drawn = section(w);
    if (drawn) cuts.append(drawn);
  }
  // The section through the pixel, if one was drawn (compare/report/section_picture.h). Those of the live picture have none: its
  // pixels are others.
  function section(w) {
    var figure = !w.live && document.querySelector(
                     '.sections[data-point="' + p.id + '"] figure[data-x="' + w.x + '"][data-y="' + w.y + '"]');
    if (!figure) return null;
    return make('figure', {class: 'section'}, [
      figure.querySelector('img').cloneNode(true),
      make('figcaption', {}, 'The plane of its light ray, cut through the surface and the map')
    ]);
  }
  // The pixel and its neighbours, each 12 times as large.
  function cut(q, x, y) {
    var canvas = make('canvas', {width: 156, height: 156, role: 'img', 'aria-label': 'The worst pixel in ' + q.name}),
        picture = new Image();
    picture.onload = function() {
      var c = canvas.getContext('2d'), px = Math.floor(x * picture.naturalWidth),
          py = Math.floor(y * picture.naturalHeight);
      c.imageSmoothingEnabled = false;
      c.drawImage(picture, px - 6, py - 6, 13, 13, 0, 0, 156, 156);
      c.lineWidth = 4;
      c.strokeStyle = '#000';
      c.strokeRect(70, 70, 16, 16);
      c.lineWidth = 2;
      c.strokeStyle = '#fff';
      c.strokeRect(70, 70, 16, 16);
    };
    picture.src = q.src;
    return make('figure', {}, [canvas, make('figcaption', {}, q.name)]);
  }
  var controls = make('div', {class: 'controls'}, [
    kit.picker('Left', options(), left.name, pick('left')), kit.picker('Right', options(), right.name, pick('right')),
    make('label', {}, ['Divide', divide]),
    button(
        '−',
        function() {
          zoom(0.5);
        },
        {'aria-label': 'Smaller'}),
    button(
        '+',
        function() {
          zoom(2);
        },
        {'aria-label': 'Larger'})
  ]);
  var choices = worstChoices(p);
  if (choices.every(function(c) {
        return c[0] !== state.worst;
      }))
    state.worst = 'error';
  if (choices.length > 1)
    controls.append(kit.picker('Worst pixel of', choices, state.worst, function(c) {
      state.worst = c;
      mark();
    }));
  a.addEventListener('load', mark);
  box.append(controls, view, said, cuts);
  show();
  box.zoom = zoom;
  box.choose = function(i) {
    if (list[i]) pick('right')(list[i].name);
    controls.querySelectorAll('select')[1].value = right.name;
  };
  return box;
}

function commandOf(p) {
  if (data.frames) return data.frames;
  var list = data.command.concat(p.set || []);
  if (mode() === 'recommended' && p.at) {
    list = list.filter(function(word) {
      return word.replace(/^'/, '').indexOf(p.at.parameter + '=') !== 0;
    });
    list.push(p.at.parameter + '=' + p.at.value);
  }
  return 'noonmark render' +
      list.map(function(word) {
            return ' --set ' + word;
          })
          .join('');
}
function command(p) {
  var text = commandOf(p), code = make('code', {}, text), told = make('span', {class: 'small', role: 'status'});
  function copied() {
    told.textContent = 'Copied.';
  }
  function copy() {
    var selection = getSelection();
    selection.selectAllChildren(code);
    if (navigator.clipboard)
      navigator.clipboard.writeText(text).then(copied, function() {
        if (document.execCommand('copy')) copied();
      });
    else if (document.execCommand('copy'))
      copied();
  }
  return make('section', {class: 'card-command', 'aria-label': 'Command'}, [
    make('h3', {}, data.frames ? 'The command that judged the frames' : 'The command that renders it'), make('p', {class: 'command'}, code),
    make('p', {}, [button('Copy', copy), ' ', told])
  ]);
}

function numbers(p) {
  var at = (p.at && p.at.metrics) || {}, both = Object.keys(at).length > 0;
  var head = [make('th', {scope: 'col'}, 'Metric'), make('th', {scope: 'col'}, 'As set')];
  if (both) head.push(make('th', {scope: 'col'}, data.bias_word));
  var rows =
      data.metrics
          .filter(function(m) {
            return m.name in p.metrics;
          })
          .map(function(m) {
            var cells = [
              make('th', {scope: 'row', title: m.help}, m.label), make('td', {}, kit.shown(p.metrics[m.name], m.unit))
            ];
            if (both) cells.push(make('td', {}, m.name in at ? kit.shown(at[m.name], m.unit) : '–'));
            return make('tr', {}, cells);
          });
  return make('section', {'aria-label': 'Numbers'}, [
    make('h3', {}, 'All numbers'),
    make(
        'div', {class: 'scroll tall', tabindex: '0', role: 'region', 'aria-label': 'All numbers of the point'},
        [make('table', {class: 'numbers'}, [make('thead', {}, make('tr', {}, head)), make('tbody', {}, rows)])])
  ]);
}

function verdict(p) {
  var text = [];
  (p.failures || []).forEach(function(f) {
    text.push(f.text.charAt(0).toUpperCase() + f.text.slice(1) + '.');
  });
  if (p.part) text.push('Part ' + p.part + '.');
  if (p.at)
    text.push(
        (mode() === 'recommended' ? 'Shown' : 'Recommended') + ' at ' + p.at.parameter + ' ' + p.at.text +
        (p.at.usable ? ', which is usable.' : p.no_window ? ', of least error; what is usable is ' + p.no_window + '.' :
                        ', the best that there is: no ' + p.at.word + ' is usable.'));
  if (p.curve) {
    var placed = p.curve.placements > 1, low = placed ? p.curve.window_min_worst_depth : p.curve.window_min_depth,
        high = placed ? p.curve.window_max_worst_depth : p.curve.window_max_depth;
    text.push(
        typeof low !== 'number' ? 'Its usable window is ' + (p.no_window || 'empty') + '.' :
                                  'Usable from ' + kit.digits(low * p.curve.m_per_depth) + ' to ' +
                kit.digits(high * p.curve.m_per_depth) + ' m' +
                (placed ? ' at every placement of the grid.' : '.'));
  } else if (p.reductions) {
    var window = kit.windowOfReduction(p);
    text.push(
        window ? 'Usable reductions: ' + kit.digits(window.from) + ' to ' + kit.digits(window.to) +
                (window.placed ? ' at every placement of the grid.' : '.') :
                 p.no_window ? 'Its usable window is ' + p.no_window + '.' : 'No reduction is usable.');
  }
  return make('p', {}, text.join(' '));
}

var shownStage = null;
function fill() {
  var p = kit.byId[page.selected];
  title.textContent = kit.nameOf(p, mode());
  inner.textContent = '';
  if (p.at)
    inner.append(make('div', {class: 'controls'}, [
      kit.freeLabel(p.at.word) + ' ',
      kit.segments(
          [['set', 'As set'], ['recommended', data.bias_word]], mode(),
          function(chosen) {
            state.bias = chosen;
            fill();
          })
    ]));
  shownStage = stage(p);
  inner.append(verdict(p), shownStage, command(p), numbers(p));
}
// how: 'recommended' shows the recommended bias, the name of a metric the bound on it that is broken at this point.
// Without it a point with a broken bound shows its failure, another one the bias of the page.
page.open = function(id, how) {
  if (!kit.byId[id]) return;
  var broken = (kit.byId[id].failures || []).map(function(f) {
    return f.metric;
  });
  var metric = how === 'recommended' ? undefined : broken.indexOf(how) >= 0 ? how : broken[0];
  state.bias = how === 'recommended' ? 'recommended' : metric ? 'set' : null;
  state.worst = metric || 'error';
  page.select(id);
  fill();
  kit.hideTip();
  if (!card.open) card.showModal();
  card.scrollTop = 0;
  title.focus();
};
page.onBias.push(function() {
  state.bias = null;
  if (card.open) fill();
});
card.addEventListener('keydown', function(event) {
  if (/^(SELECT|INPUT|TEXTAREA)$/.test(event.target.tagName) || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === '+' && shownStage.zoom)
    shownStage.zoom(2);
  else if (event.key === '-' && shownStage.zoom)
    shownStage.zoom(0.5);
  else if (event.key >= '1' && event.key <= '9' && shownStage.choose)
    shownStage.choose(+event.key - 1);
  else
    return;
  event.preventDefault();
});
card.addEventListener('click', function(event) {  // on what is around the card
  if (event.target === card) card.close();
});
document.addEventListener('click', function(event) {
  var link = event.target.closest && event.target.closest('a[href^="#p"]'), id = link && /^#p(\d+)$/.exec(link.hash);
  if (!id || !kit.byId[id[1]]) return;
  event.preventDefault();
  page.open(+id[1], link.dataset.show || link.dataset.failure);
});
document.querySelectorAll('.places .row').forEach(function(row) {
  row.addEventListener('click', function(event) {
    if (!event.target.closest('a')) page.open(+row.dataset.point);
  });
});
page.openByAddress = function() {
  var id = /^#p(\d+)$/.exec(location.hash);
  if (id) page.open(+id[1]);
};
addEventListener('hashchange', page.openByAddress);
})();
