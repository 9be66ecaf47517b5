// The first figure (compare/report/function_figure.cpp draws it): its lists choose a grid, the pointer reads a chart's numbers, a
// click opens the point.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, figure = document.getElementById('chart-function');
if (!figure) return;
function list(selector, root) {
  return Array.prototype.slice.call((root || figure).querySelectorAll(selector));
}
var plot = figure.querySelector('.plot'), grids = list('.function-grid'), lists = list('.controls select');
var names = plot.dataset.names.split('|'), causes = plot.dataset.causes.split('|'), current;

function chosen(grid) {
  return grid.dataset.chosen.split('|');
}
function show(grid) {
  current = grid;
  grids.forEach(function(g) {
    g.hidden = g !== grid;
  });
  lists.forEach(function(l, i) {
    if (chosen(grid)[i]) l.value = chosen(grid)[i];
  });
}
// The grid that shares most with what the lists say, above all the value that was just chosen.
lists.forEach(function(changed) {
  changed.addEventListener('change', function() {
    function shared(grid) {
      return lists.reduce(function(sum, l, i) {
        return sum + (l.value === chosen(grid)[i]) * (l === changed ? 100 : 1);
      }, 0);
    }
    show(grids.reduce(function(best, grid) {
      return shared(grid) > shared(best) ? grid : best;
    }));
  });
});
function cells(grid) {
  return list('.cell', grid);
}
// The entry of "at" nearest to the event, as its index.
function nearest(cell, event, at) {
  var box = cell.getBoundingClientRect(), x = 1000 * (event.clientX - box.left) / box.width;
  return at.reduce(function(best, place, i) {
    return Math.abs(place - x) < Math.abs(at[best] - x) ? i : best;
  }, 0);
}
// The narrow picture's charts have the numbers of the wide one's.
function numbers(cell) {
  return list('.wide .cell', cell.closest('.function-grid')).filter(function(c) {
    return c.dataset.cell === cell.dataset.cell;
  })[0].dataset;
}
function points(cell) {
  return numbers(cell).points.split(' ').map(function(p) {
    return p.split(':').map(Number);
  });
}
function leave() {
  kit.hideTip();
  list('.cursor').forEach(function(line) {
    line.setAttribute('visibility', 'hidden');
  });
}
plot.addEventListener('mousemove', function(event) {
  leave();
  var cell = event.target.closest('.cell');
  if (!cell) return;
  var at = numbers(cell).at.split(' ').map(Number), i = nearest(cell, event, at);
  var says = numbers(cell).tips.split(';')[i].split('|'), cursor = cell.parentNode.querySelector('.cursor');
  var x = +cell.getAttribute('x') + at[i] * cell.getAttribute('width') / 1000, y = +cell.getAttribute('y');
  [['x1', x], ['x2', x], ['y1', y], ['y2', y + +cell.getAttribute('height')], ['visibility', 'visible']].forEach(function(a) {
    cursor.setAttribute(a[0], a[1]);
  });
  kit.showTip(
      event, names.map(function(name, k) {
        return [name, says[k + 1], causes[k]];
      }),
      says[0]);
});
plot.addEventListener('mouseleave', leave);
plot.addEventListener('click', function(event) {
  var cell = event.target.closest('.cell');
  if (!cell) return;
  var all = points(cell), i = nearest(cell, event, all.map(function(p) {
    return p[1];
  }));
  page.open(all[i][0]);
});
page.onSelect.push(function(id) {
  list('.cell').forEach(function(cell) {
    var here = points(cell).some(function(p) {
      return p[0] === id;
    });
    cell.classList.toggle('selected', here);
    if (here) show(cell.closest('.function-grid'));
  });
});
show(grids[0]);
// The arrow keys go from chart to chart, each at the bias as set.
kit.keyboard({plot: plot}, function() {
  return cells(current)
      .filter(function(cell) {
        return cell.getBoundingClientRect().width;
      })
      .map(function(cell) {
        var box = cell.getBoundingClientRect();
        return {element: cell, x: box.left + points(cell)[0][1] * box.width / 1000, y: box.top + box.height / 2};
      });
});
})();
