// Runs in any page of Noonmark (tests/compare/report/layout_test.cpp): how it is laid out, and what its buttons save.
(async function() {
'use strict';
var saw = {errors: errors}, root = document.scrollingElement;
function all(selector) {
  return Array.prototype.slice.call(document.querySelectorAll(selector));
}
function later() {
  return new Promise(function(go) {
    setTimeout(go, 0);
  });
}
if (window.noonmarkReady) await window.noonmarkReady;
if (window.noonmarkPage && window.noonmarkPage.liveReady) await window.noonmarkPage.liveReady;
await later();  // Vega draws only after the script that called it has ended
saw.width = root.clientWidth;
saw.needed = root.scrollWidth;
all('details').forEach(function(d) {
  d.open = true;
});
saw.needed_unfolded = root.scrollWidth;
saw.labels = all('.budget .name').map(function(e) {
  return e.textContent;
});
saw.cut = all('.budget .name').filter(function(e) {
  return e.scrollWidth > e.clientWidth + 1 || e.scrollHeight > e.clientHeight + 1;
}).length;
saw.stacked = all('table.stacked').length;
saw.stacked_that_scroll = all('.scroll').filter(function(e) {
  return e.querySelector('table.stacked') && e.scrollWidth > e.clientWidth + 1;
}).length;
// Where the numbers of a column have their point, in pixels: the right edge of the digits before it.
saw.points = {};
all('table.sortable').forEach(function(table) {
  Array.prototype.forEach.call(table.tHead.rows[0].cells, function(head, i) {
    saw.points[head.textContent] = Array.prototype.map
                                       .call(
                                           table.tBodies[0].rows,
                                           function(row) {
                                             var text = row.cells[i].firstChild, range = document.createRange();
                                             if (!text || text.nodeType !== Node.TEXT_NODE) return null;
                                             var whole = /^\d+/.exec(text.data);
                                             if (!whole) return null;
                                             range.setStart(text, 0);
                                             range.setEnd(text, whole[0].length);
                                             return range.getBoundingClientRect().right;
                                           })
                                       .filter(function(x) {
                                         return x !== null;
                                       });
  });
});

// The first picture, at the bias as set and at another one.
function live() {
  return {
    whole: all('#live-picture img.whole:not([hidden])').map(function(i) {
      return i.naturalWidth;
    }),
    canvas: all('#live-picture canvas:not([hidden])').length,
    facts: document.querySelector('#live-picture .facts').textContent
  };
}
var slider = document.querySelector('#live-picture input');
if (slider) {
  await Promise.all(all('#live-picture img').map(function(i) {
    return i.complete ? null : new Promise(function(go) {
      i.addEventListener('load', go);
    });
  }));
  saw.live = {first: live()};
  slider.value = +slider.value + 40;
  slider.dispatchEvent(new Event('input', {bubbles: true}));
  saw.live.moved = live();
  all('#live-picture .controls button')
      .filter(function(b) {
        return b.textContent === 'As set';
      })[0]
      .click();
  saw.live.back = live();
}

// What the buttons save.
var files = [], click = HTMLAnchorElement.prototype.click;
HTMLAnchorElement.prototype.click = function() {
  files.push({name: this.download, address: this.href});
};
var save = all('figure.chart .save button');
saw.charts = all('figure.chart').length;
saw.charts_with_save = all('figure.chart .save').length;
save.forEach(function(b) {
  b.click();
});
for (var i = 0; i < 100 && files.length < save.length; ++i) await new Promise(function(go) {
  setTimeout(go, 20);
});
HTMLAnchorElement.prototype.click = click;
saw.files = files.map(function(f) {
  var svg = /^data:image\/svg\+xml;charset=utf-8,(.*)$/.exec(f.address);
  if (!svg) return {name: f.name, png: f.address.indexOf('data:image/png;base64,iVBORw0KGgo') === 0, size: f.address.length};
  var text = decodeURIComponent(svg[1]), read = new DOMParser().parseFromString(text, 'image/svg+xml');
  return {
    name: f.name,
    svg: !read.querySelector('parsererror'),
    variables: (text.match(/var\(/g) || []).length,
    marks: read.querySelectorAll('path').length,
    text: read.documentElement.textContent
  };
});

leave(saw);
})();
