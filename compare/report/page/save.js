// Buttons that save a figure: as SVG and as PNG, and a picture of pixels as PNG alone. A saved file needs nothing of the
// page: it has the legend, and colours and fonts in place of the page's variables.
(function() {
'use strict';
var page = window.noonmarkPage, kit = page.kit, namespace = 'http://www.w3.org/2000/svg';
var pad = 12, gap = 8, per_px = 2;  // PNG: pixels for each pixel of CSS

function node(tag, attributes, text) {
  var e = document.createElementNS(namespace, tag);
  Object.keys(attributes).forEach(function(k) {
    e.setAttribute(k, attributes[k]);
  });
  if (text !== undefined) e.textContent = text;
  return e;
}
function nested(svg, x, y, width, height) {
  var copy = svg.cloneNode(true);
  [['x', x], ['y', y], ['width', width], ['height', height]].forEach(function(a) {
    copy.setAttribute(a[0], a[1]);
  });
  return copy;
}
// Draws the entries of a legend where the page has them. Returns the legend's height.
function addLegend(root, legend, top) {
  var box = legend.getBoundingClientRect();
  function at(rect) {
    return {x: pad + rect.left - box.left, y: top + rect.top - box.top, width: rect.width, height: rect.height};
  }
  legend.querySelectorAll(':scope > span').forEach(function(entry) {
    var style = getComputedStyle(entry);
    entry.childNodes.forEach(function(part) {
      if (part.nodeType === Node.TEXT_NODE) {
        var range = document.createRange();
        range.selectNode(part);
        var text = at(range.getBoundingClientRect());
        root.append(node(
            'text', {
              x: text.x,
              y: text.y + 0.78 * text.height,
              fill: style.color,
              'font-family': 'var(--sans)',
              'font-size': style.fontSize
            },
            part.textContent));
        return;
      }
      var place = at(part.getBoundingClientRect());
      if (part.tagName === 'svg')
        root.append(nested(part, place.x, place.y, place.width, place.height));
      else
        root.append(node('rect', Object.assign(place, {rx: 2, fill: getComputedStyle(part).backgroundColor})));
    });
  });
  return box.height;
}
// The page's variables as their values.
function resolved(text) {
  var style = getComputedStyle(document.documentElement);
  return text.replace(/var\((--[\w-]+)\)/g, function(whole, name) {
    return style.getPropertyValue(name).trim().replace(/"/g, '\'');
  });
}
// The chart with its legend below it.
function svgOf(figure, chart) {
  // Of the first figure the wide picture is saved, which a narrow screen does not show.
  var box = chart.viewBox.baseVal, root = node('svg', {}), legend = figure.querySelector('.legend');
  var height = pad + box.height + pad, width = box.width + 2 * pad;
  root.append(node('title', {}, nameOf(figure)), node('rect', {width: '100%', height: '100%', fill: 'var(--card)'}));
  var copy = nested(chart, pad, pad, box.width, box.height);
  // Cells that touch show no seams, as style.css says of the page.
  copy.querySelectorAll('.mark-rect path').forEach(function(cell) {
    cell.setAttribute('shape-rendering', 'crispEdges');
  });
  root.append(copy);
  if (legend && legend.children.length) {
    height += gap + addLegend(root, legend, pad + box.height + gap);
    width = Math.max(width, legend.getBoundingClientRect().width + 2 * pad);
  }
  [['width', width], ['height', height], ['viewBox', '0 0 ' + width + ' ' + height]].forEach(function(a) {
    root.setAttribute(a[0], a[1]);
  });
  root.setAttribute('color', getComputedStyle(figure).color);
  return {width: width, height: height, text: resolved(new XMLSerializer().serializeToString(root))};
}
function nameOf(figure) {
  var caption = figure.querySelector(':scope > figcaption').firstChild;
  return document.querySelector('h1').textContent + (caption ? ': ' + caption.textContent : '');
}
function fileOf(figure, ending) {
  var all = Array.prototype.slice.call(document.querySelectorAll('figure.chart'));
  return 'noonmark-' + (figure.id || 'chart-' + (1 + all.indexOf(figure))).replace(/^chart-/, '') + '.' + ending;
}
function download(address, file) {
  kit.make('a', {href: address, download: file}).click();
}
function addressOf(svg) {
  return 'data:image/svg+xml;charset=utf-8,' + encodeURIComponent(svg.text);
}
function savePng(source, width, height, figure) {
  var canvas = kit.make('canvas', {width: Math.round(width), height: Math.round(height)});
  canvas.getContext('2d').drawImage(source, 0, 0, canvas.width, canvas.height);
  download(canvas.toDataURL('image/png'), fileOf(figure, 'png'));
}
function button(label, act) {
  return kit.make('button', {type: 'button', 'aria-label': 'Save as ' + label, on: {click: act}}, label);
}
// What the figure shows now, because a chart is drawn again when something is chosen.
function chartOf(figure) {
  return figure.querySelector('.plot > :not([hidden]) svg') || figure.querySelector(':scope > svg');
}
function pixelsOf(figure) {
  return figure.querySelector('img.whole:not([hidden])') || figure.querySelector('canvas');
}
document.querySelectorAll('figure.chart').forEach(function(figure) {
  var save = kit.make('span', {class: 'save'}, 'Save ');
  if (figure.querySelector('canvas'))
    save.append(button('PNG', function() {
      var shown = pixelsOf(figure);
      savePng(shown, shown.naturalWidth || shown.width, shown.naturalHeight || shown.height, figure);
    }));
  else
    save.append(
        button(
            'SVG',
            function() {
              var chart = chartOf(figure);
              if (chart) download(addressOf(svgOf(figure, chart)), fileOf(figure, 'svg'));
            }),
        ' ', button('PNG', function() {
          var chart = chartOf(figure);
          if (!chart) return;
          var svg = svgOf(figure, chart), image = new Image();
          image.onload = function() {
            savePng(image, per_px * svg.width, per_px * svg.height, figure);
          };
          image.src = addressOf(svg);
        }));
  figure.querySelector(':scope > figcaption').append(' ', save);
});
})();
