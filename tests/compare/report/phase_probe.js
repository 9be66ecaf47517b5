// Runs in the page of a phase diagram after its own scripts (tests/compare/report/page_test.cpp). It points at the cell
// of the coarsest texel and the least bias, clicks it, and writes its observations to the element `probe`.
(async function() {
'use strict';
var saw = {errors: errors};
function all(selector, root) {
  return Array.prototype.slice.call((root || document).querySelectorAll(selector));
}
var figure = document.getElementById('chart-phase'), cells = all('.mark-rect.role-mark path', figure);
saw.cells = cells.length;
saw.lines = all('.mark-line path', figure).length;
saw.hatch = all('.mark-rule.role-mark line', figure).length;
saw.texts = all('.mark-text.role-mark text', figure).map(function(t) {
  return t.textContent;
});
var cell = cells[0], box = cell.getBoundingClientRect();
function send(kind) {
  cell.dispatchEvent(new MouseEvent(
      kind, {bubbles: true, cancelable: true, clientX: box.left + box.width / 2, clientY: box.top + box.height / 2}));
}
send('mousemove');
saw.tip = document.getElementById('tip').textContent;
send('click');
await new Promise(function(go) {
  setTimeout(go, 0);
});
var code = figure.querySelector('.command code');
saw.command = code ? code.textContent : '';
saw.rows = all('#phase table.numbers tbody tr').length;
saw.title = document.querySelector('h1').textContent;

var probe = document.createElement('pre');
probe.id = 'probe';
probe.textContent = JSON.stringify(saw).replace(/[<>&]/g, function(c) {
  return '\\u00' + c.charCodeAt(0).toString(16);
});
document.body.append(probe);
})();
