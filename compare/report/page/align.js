// Aligns the numbers of a table on their decimal points: what a number lacks of its column's digits after the point is
// added to its right. Digits are of equal width (tabular-nums).
(function() {
'use strict';
var kit = window.noonmarkPage.kit;
var number = /^[+−-]?[\d\u202f]+(\.(\d+))?$/;

// The width of what follows the digits before the point, in digits; the point takes half of one. Null: no number.
function tail(cell) {
  var found = number.exec(cell.textContent.trim());
  return found && (found[2] ? 0.5 + found[2].length : 0);
}
// The bodies' rows of one table. All cells of a row, so that the index is the column; cells that span columns end a row.
kit.align = function(table) {
  var widest = [], cells = [];
  Array.prototype.forEach.call(table.tBodies, function(body) {
    Array.prototype.forEach.call(body.rows, function(row) {
      for (var i = 0; i < row.cells.length && row.cells[i].colSpan === 1; ++i) {
        var of = tail(row.cells[i]);
        if (of === null) continue;
        cells.push({cell: row.cells[i], column: i, tail: of});
        widest[i] = Math.max(widest[i] || 0, of);
      }
    });
  });
  cells.forEach(function(c) {
    c.cell.style.setProperty('--lacks', widest[c.column] - c.tail);
  });
};
document.querySelectorAll('table.numbers').forEach(kit.align);
})();
