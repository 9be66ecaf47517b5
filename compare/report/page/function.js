// The first figure (compare/report/function_figure.cpp draws it): its lists choose a grid, the pointer reads a chart's numbers, a
// click opens the point.
(() => {
'use strict';
const page = window.noonmarkPage, kit = page.kit, figure = document.getElementById('chart-function');
if (!figure) return;
const list = (selector, root) => Array.from((root || figure).querySelectorAll(selector));
const plot = figure.querySelector('.plot'), grids = list('.function-grid'), lists = list('.controls select');
const names = plot.dataset.names.split('|'), causes = plot.dataset.causes.split('|');
const chosen = grid => grid.dataset.chosen.split('|');

function show(grid) {
  grids.forEach(g => g.hidden = g !== grid);
  lists.forEach((l, i) => l.value = chosen(grid)[i] || l.value);
}
// The grid that shares most with what the lists say, above all the value that was just chosen.
lists.forEach(changed => changed.addEventListener('change', () => {
  const shared = grid =>
      lists.reduce((sum, l, i) => sum + (l.value === chosen(grid)[i]) * (l === changed ? 100 : 1), 0);
  show(grids.reduce((best, grid) => shared(grid) > shared(best) ? grid : best));
}));
// The narrow picture's charts have the numbers of the wide one's.
const numbers = cell => list('.wide .cell', cell.closest('.function-grid'))
                            .find(c => c.dataset.cell === cell.dataset.cell)
                            .dataset;
// [id, place] of each point.
const points = cell => numbers(cell).points.split(' ').map(p => p.split(':').map(Number));
// The index of the place nearest to the event.
function nearest(cell, event, places) {
  const box = cell.getBoundingClientRect(), x = 1000 * (event.clientX - box.left) / box.width;
  return places.reduce((best, place, i) => Math.abs(place - x) < Math.abs(places[best] - x) ? i : best, 0);
}
function leave() {
  kit.hideTip();
  list('.cursor').forEach(line => line.setAttribute('visibility', 'hidden'));
}
plot.addEventListener('mousemove', event => {
  leave();
  const cell = event.target.closest('.cell');
  if (!cell) return;
  const at = numbers(cell).at.split(' ').map(Number), i = nearest(cell, event, at);
  const says = numbers(cell).tips.split(';')[i].split('|'), cursor = cell.parentNode.querySelector('.cursor');
  const x = +cell.getAttribute('x') + at[i] * cell.getAttribute('width') / 1000, y = +cell.getAttribute('y');
  const line = {x1: x, x2: x, y1: y, y2: y + +cell.getAttribute('height'), visibility: 'visible'};
  Object.keys(line).forEach(name => cursor.setAttribute(name, line[name]));
  kit.showTip(event, names.map((name, k) => [name, says[k + 1], causes[k]]), says[0]);
});
plot.addEventListener('mouseleave', leave);
plot.addEventListener('click', event => {
  const cell = event.target.closest('.cell');
  if (cell) page.open(points(cell)[nearest(cell, event, points(cell).map(p => p[1]))][0]);
});
page.onSelect.push(id => list('.cell').forEach(cell => {
  const here = points(cell).some(p => p[0] === id);
  cell.classList.toggle('selected', here);
  if (here) show(cell.closest('.function-grid'));
}));
show(grids[0]);
// The arrow keys go from chart to chart, each at the bias as set.
kit.keyboard({plot: plot}, () => list('.cell').map(cell => ({cell, box: cell.getBoundingClientRect()})).filter(c => c.box.width).map(c => ({
  element: c.cell,
  x: c.box.left + points(c.cell)[0][1] * c.box.width / 1000,
  y: c.box.top + c.box.height / 2
})));
})();
