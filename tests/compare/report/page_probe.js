// Runs in the report's page after its own scripts (tests/compare/report/page_test.cpp). It uses the page as a reader
// does, with clicks and keys, and writes its observations to the element `probe`. The first script of the page makes
// the list `errors`.
(async function() {
'use strict';
var saw = {errors: errors};
function all(selector, root) {
  return Array.prototype.slice.call((root || document).querySelectorAll(selector));
}
// Vega draws only after the script that called it has ended.
function drawn() {
  return new Promise(function(go) {
    setTimeout(go, 0);
  });
}
async function click(element) {
  element.dispatchEvent(new MouseEvent('click', {bubbles: true, cancelable: true, view: window}));
  await drawn();
}
function press(key) {
  document.dispatchEvent(new KeyboardEvent('keydown', {key: key, bubbles: true, cancelable: true}));
}
function button(figure, text) {
  return all('button', figure).filter(function(b) {
    return b.textContent === text;
  })[0];
}
function marks(figure) {
  var count = {};
  ['line', 'area', 'symbol', 'rule'].forEach(function(kind) {
    count[kind] = all('.mark-' + kind + ' path, .mark-' + kind + ' line', figure).length;
  });
  count.zero = all('.mark-text.role-mark text', figure).filter(function(t) {
    return t.textContent === '0';
  }).length;
  return count;
}
function selected() {
  return all('tr.selected').map(function(row) {
    return +row.dataset.point;
  });
}

saw.charts = {};
all('figure[id^="chart-"]').forEach(function(figure) {
  saw.charts[figure.id] = marks(figure);
});

var bias = document.getElementById('chart-bias');
function axis_titles() {
  return all('.mark-text.role-axis-title text', bias).map(function(t) {
    return t.textContent;
  });
}
saw.bias = {depth: axis_titles(), facts: bias.querySelector('.facts').textContent};
await click(button(bias, 'texels'));
saw.bias.texels = axis_titles();
await click(button(bias, 'Stacked'));
saw.bias.stacked = marks(bias);
saw.bias.pressed = all('button[aria-pressed="true"]', bias).map(function(b) {
  return b.textContent;
});
await click(button(bias, 'Lines'));
var svg = bias.querySelector('.plot svg'), box = svg.getBoundingClientRect();
svg.dispatchEvent(
    new MouseEvent('mousemove', {bubbles: true, clientX: box.left + box.width / 2, clientY: box.top + 40}));
saw.bias.tip = document.getElementById('tip').textContent;
svg.dispatchEvent(new MouseEvent('mouseleave'));
saw.bias.tip_hidden = document.getElementById('tip').hidden;

// The table: a click on a heading sorts, and a second click reverses the order. A click on a row selects its point in
// all charts and pictures.
var table = document.querySelector('table.sortable'), heads = all('th', table.tHead);
function column(name) {
  return heads.findIndex(function(h) {
    return h.textContent.indexOf(name) === 0;
  });
}
function order(i) {
  return all('tr', table.tBodies[0]).map(function(row) {
    return row.cells[i].dataset.v;
  });
}
var error = column('Error'), filter = column('filter');
saw.table = {error: []};
for (var i = 0; i < 2; ++i) {
  await click(heads[error]);
  saw.table.error.push(order(error));
}
saw.table.sorted = heads[error].getAttribute('aria-sort');
heads[filter].dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter', bubbles: true}));
saw.table.filter = order(filter);
await click(document.getElementById('p5').cells[1]);
saw.selected_by_row = selected();
saw.facts_of_5 = bias.querySelector('.facts').textContent;
var symbol = document.querySelector('[id^="chart-sweep"] .mark-symbol path');
saw.symbol = symbol.__data__.datum.id;
await click(symbol);
saw.selected_by_symbol = selected();

// Pictures: keys change them only while they are in view and no list has the focus.
var set = document.querySelector('.pictures');
function shown() {
  var visible = all('.pictures').filter(function(s) {
    return !s.hidden;
  });
  return visible.length + ' ' + visible[0].dataset.point + ' ' + all('figure.shown', visible[0]).map(function(f) {
    return f.dataset.name;
  });
}
var picker = document.querySelector('.picture-picker select');
function show_point(id) {
  picker.value = id;
  picker.dispatchEvent(new Event('change'));
}
show_point(set.dataset.point);
window.scrollTo({top: 0, behavior: 'instant'});
press('ArrowRight');
saw.flips = [shown()];  // not in view: nothing happens
set.scrollIntoView({behavior: 'instant'});
['ArrowRight', 'ArrowRight', 'ArrowRight', 'ArrowLeft', '2', '9'].forEach(function(key) {
  press(key);
  saw.flips.push(shown());
});
picker.focus();
press('ArrowRight');
saw.flips.push(shown());
picker.blur();
show_point(all('.pictures')[1].dataset.point);
saw.flips.push(shown());

var probe = document.createElement('pre');
probe.id = 'probe';
probe.textContent = JSON.stringify(saw).replace(/[<>&]/g, function(c) {
  return '\\u00' + c.charCodeAt(0).toString(16);
});
document.body.append(probe);
})();
