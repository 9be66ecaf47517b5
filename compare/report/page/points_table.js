// The table of points: rows are made when they come into view, sorted by any column, searched and filtered by part. The
// numbers are those of the bias that the reader chose. Readers without JavaScript have a table of their own.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, make = kit.make, data = page.data;
var place = document.querySelector('.points-place');
if (!place || !data.points.length) return;
var at_once = 60;
var parts = data.points.reduce(function(list, p) {
  if (p.part !== undefined && list.indexOf(p.part) < 0) list.push(p.part);
  return list;
}, []);
function varies(m) {
  var first = data.points[0].metrics[m.name];
  return data.points.length === 1 ? m.name in data.points[0].metrics : data.points.some(function(p) {
    return p.metrics[m.name] !== first || (p.at && p.at.metrics && m.name in p.at.metrics);
  });
}
var columns = [{
  label: 'Point',
  value: function(p) {
    return p.id;
  }
}];
if (parts.length)
  columns.push({
    label: 'Part',
    text: true,
    value: function(p) {
      return p.part;
    }
  });
data.swept.forEach(function(s) {
  columns.push({
    label: s.label,
    unit: s.unit,
    help: s.name,
    text: !s.numeric,
    value: function(p) {
      return p.settings[s.name];
    },
    show: function(v) {
      return kit.valueText(s, v);
    }
  });
});
data.metrics.filter(varies).forEach(function(m) {
  columns.push({
    label: m.label,
    unit: m.unit === 'fraction' ? '%' :
        m.unit === 'bytes'      ? 'MB' :
        m.unit === 'count'      ? '' :
                                  m.unit,
    help: m.help,
    scale: m.unit === 'fraction' ? 100 :
        m.unit === 'bytes'       ? 1e-6 :
                                   1,
    metric: true,
    value: function(p) {
      return m.name in p.metrics ? kit.value(p, m.name) : undefined;
    }
  });
});

var sorted = {column: 0, down: false}, words = [], part = '', rows = [], made = 0;
var body = make('tbody'), head = make('tr'), count = make('span', {class: 'small', role: 'status'});
var heads = columns.map(function(c, i) {
  var button = make(
      'button', {
        type: 'button',
        title: c.help || '',
        on: {
          click: function() {
            sorted = {column: i, down: sorted.column === i && heads[i].hasAttribute('aria-sort') && !sorted.down};
            heads.forEach(function(h) {
              h.removeAttribute('aria-sort');
            });
            heads[i].setAttribute('aria-sort', sorted.down ? 'descending' : 'ascending');
            fill();
          }
        }
      },
      c.label);
  if (c.unit) button.append(' ', make('small', {}, c.unit));
  return make('th', {scope: 'col', class: c.text ? 'text' : ''}, button);
});
heads.forEach(function(h) {
  head.append(h);
});
var scroll = make(
    'div', {class: 'scroll tall', tabindex: '0', role: 'region', 'aria-label': 'Table of points'},
    [make('table', {class: 'numbers sortable'}, [make('thead', {}, head), body])]);

function cell(c, p) {
  var v = c.value(p),
      shown = v === undefined ? '–' :
      !c.metric               ? String(c.show ? c.show(v) : v) :
      kit.finite(v)           ? kit.digits(c.scale * v) :
                                'not finite';
  var td = make(c === columns[0] ? 'th' : 'td', v === undefined ? {} : {'data-v': v});
  if (c === columns[0]) {
    td.setAttribute('scope', 'row');
    td.append(make('a', {href: '#p' + p.id}, shown));
  } else
    td.append(shown);
  if (c.text) td.className = 'text';
  if (c.metric && v !== undefined && !kit.finite(v)) td.className = 'fails';
  return td;
}
function more(n) {
  var end = Math.min(rows.length, made + n);
  for (; made < end; ++made) {
    var p = rows[made];
    var tr = make('tr', {id: 'p' + p.id, 'data-point': p.id}, columns.map(function(c) {
      return cell(c, p);
    }));
    if (p.id === page.selected) tr.className = 'selected';
    body.append(tr);
  }
  kit.align(scroll.querySelector('table'));
}
function compare(a, b) {
  var c = columns[sorted.column], x = c.value(a), y = c.value(b), m = +x, n = +y, sign = sorted.down ? -1 : 1;
  if (numeric(c)) {
    if (isNaN(m) || isNaN(n)) return isNaN(m) - isNaN(n);  // values that are not finite are always last
    return (m - n) * sign;
  }
  return (String(x) < String(y) ? -1 : String(x) > String(y) ? 1 : 0) * sign;
}
function numeric(c) {
  return data.points.some(function(p) {
    var v = c.value(p);
    return v !== undefined && v !== '' && !isNaN(+v);
  });
}
function text(p) {
  return [p.id, p.part || '', p.phrase || '', (p.set || []).join(' ')].join(' ').toLowerCase();
}
function fill() {
  rows = data.points.filter(function(p) {
    return (!part || p.part === part) && words.every(function(w) {
      return text(p).indexOf(w) >= 0;
    });
  });
  if (heads[sorted.column].hasAttribute('aria-sort')) rows.sort(compare);
  body.textContent = '';
  made = 0;
  scroll.scrollTop = 0;
  more(at_once);
  count.textContent = rows.length + ' of ' + data.points.length + ' points';
}
var controls = make('div', {class: 'controls'});
controls.append(make('label', {}, [
  'Search', make('input', {
    type: 'search',
    on: {
      input: function(event) {
        words = event.target.value.toLowerCase().split(/\s+/).filter(Boolean);
        fill();
      }
    }
  })
]));
if (parts.length > 1)
  controls.append(kit.picker(
      'Part', [['', 'all']].concat(parts.map(function(p) {
        return [p, p];
      })),
      '', function(v) {
        part = v;
        fill();
      }));
controls.append(count);
place.append(controls, scroll);
scroll.addEventListener('scroll', function() {
  if (scroll.scrollTop + scroll.clientHeight > scroll.scrollHeight - 600) more(at_once);
});
addEventListener('beforeprint', function() {
  more(rows.length);
});
body.addEventListener('click', function(event) {
  var row = event.target.closest('tr');
  if (row && !event.target.closest('a')) page.open(+row.dataset.point);
});
page.onBias.push(fill);
page.onSelect.push(function(id) {
  document.querySelectorAll('tr.selected').forEach(function(r) {
    r.classList.remove('selected');
  });
  var row = document.getElementById('p' + id);
  if (row) row.classList.add('selected');
});
fill();
})();
