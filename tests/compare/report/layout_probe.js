// Runs in any page of Noonmark (tests/compare/report/layout_test.cpp): how it is laid out, and what its buttons save.
(async () => {
  'use strict';
  const saw = {errors}, root = document.scrollingElement;
  if (window.noonmarkPage && window.noonmarkPage.liveReady) await window.noonmarkPage.liveReady;
  await later();  // Vega draws only after the script that called it has ended
  saw.width = root.clientWidth;
  saw.needed = root.scrollWidth;
  all('details').forEach(d => d.open = true);
  saw.needed_unfolded = root.scrollWidth;
  saw.stacked = all('table.stacked').length;
  saw.stacked_that_scroll =
      all('.scroll').filter(e => e.querySelector('table.stacked') && e.scrollWidth > e.clientWidth + 1).length;
  // Where the numbers of a column have their point, in pixels: the right edge of the digits before it.
  saw.points = {};
  all('table.sortable').forEach(table => {
    Array.prototype.forEach.call(table.tHead.rows[0].cells, (head, i) => {
      saw.points[head.textContent] = Array.prototype.map
                                         .call(
                                             table.tBodies[0].rows,
                                             row => {
                                               const text = row.cells[i].firstChild, range = document.createRange();
                                               if (!text || text.nodeType !== Node.TEXT_NODE) return null;
                                               const whole = /^\d+/.exec(text.data);
                                               if (!whole) return null;
                                               range.setStart(text, 0);
                                               range.setEnd(text, whole[0].length);
                                               return range.getBoundingClientRect().right;
                                             })
                                         .filter(x => x !== null);
    });
  });

  // The first picture, at the bias as set and at another one.
  const live = () => ({
    whole: all('#live-picture img.whole:not([hidden])').map(i => i.naturalWidth),
    canvas: all('#live-picture canvas:not([hidden])').length,
    facts: document.querySelector('#live-picture .facts').textContent
  });
  const slider = document.querySelector('#live-picture input');
  if (slider) {
    await Promise.all(
        all('#live-picture img').map(i => i.complete ? null : new Promise(go => i.addEventListener('load', go))));
    saw.live = {first: live()};
    slider.value = +slider.value + 40;
    slider.dispatchEvent(new Event('input', {bubbles: true}));
    saw.live.moved = live();
    all('#live-picture .controls button').filter(b => b.textContent === 'As set')[0].click();
    saw.live.back = live();
  }

  // What the buttons save.
  const files = [], click = HTMLAnchorElement.prototype.click;
  HTMLAnchorElement.prototype.click = function() {
    files.push({name: this.download, address: this.href});
  };
  const save = all('figure.chart .save button');
  saw.charts = all('figure.chart').length;
  saw.charts_with_save = all('figure.chart .save').length;
  save.forEach(b => b.click());
  for (let i = 0; i < 100 && files.length < save.length; ++i) await new Promise(go => setTimeout(go, 20));
  HTMLAnchorElement.prototype.click = click;
  saw.files = files.map(f => {
    const svg = /^data:image\/svg\+xml;charset=utf-8,(.*)$/.exec(f.address);
    if (!svg)
      return {name: f.name, png: f.address.indexOf('data:image/png;base64,iVBORw0KGgo') === 0, size: f.address.length};
    const text = decodeURIComponent(svg[1]), read = new DOMParser().parseFromString(text, 'image/svg+xml');
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
