// The arrow keys in a chart. They go from stop to stop, from left to right, and show what the pointer would show there;
// a live region speaks it. Home and End go to the ends, Enter is the click, Escape and Tab take the tip away.
(function() {
'use strict';
var kit = window.noonmarkPage.kit;

// The marks of the chart that a pointer finds, as stops.
function marks(plot) {
  return Array.prototype.filter
      .call(
          plot.querySelectorAll('.mark-symbol path'),
          function(e) {
            var datum = e.__data__ && e.__data__.datum;
            return datum && (datum.id !== undefined || datum.point !== undefined);
          })
      .map(function(e) {
        var box = e.getBoundingClientRect();
        return {element: e, x: box.left + box.width / 2, y: box.top + box.height / 2};
      })
      .sort(function(a, b) {
        return a.x - b.x || b.y - a.y;
      });
}

// self is what kit.chart() returned. stops() returns [{element, x, y}] from left to right, in pixels of the window; without
// it the chart's marks are the stops. Each element gets the events that a pointer at its place would send.
kit.keyboard = function(self, stops) {
  var plot = self.plot, at = -1, spoken = kit.make('p', {class: 'small spoken', 'aria-live': 'polite'});
  function list() {
    return stops ? stops() : marks(plot);
  }
  function send(type, stop) {
    stop.element.dispatchEvent(
        new MouseEvent(type, {bubbles: true, cancelable: true, view: window, clientX: stop.x, clientY: stop.y}));
  }
  function leave() {
    var svg = plot.querySelector('svg');
    if (svg) svg.dispatchEvent(new MouseEvent('mouseleave'));
    kit.hideTip();
  }
  plot.after(spoken);
  plot.tabIndex = 0;
  plot.setAttribute('aria-label', plot.getAttribute('aria-label') + ' The arrow keys move, Enter is the click.');
  plot.setAttribute('role', 'application');  // so that a screen reader passes the arrow keys on
  plot.addEventListener('keydown', function(event) {
    var all = list(), to = {ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: all.length - 1}[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || !all.length) return;
    if (event.key === 'Escape')
      leave();
    else if (event.key === 'Enter' && all[at])
      send('click', all[at]);
    else if (to !== undefined) {
      at = Math.max(0, Math.min(all.length - 1, to));
      send('mousemove', all[at]);
      spoken.textContent = kit.tipWords();
    } else
      return;
    event.preventDefault();
    event.stopPropagation();
  });
  plot.addEventListener('blur', leave);
};
})();
