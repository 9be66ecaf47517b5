// The page's data block, and the start of the scripts that need it. compare/report/page_parts.cpp packs a large block, and the
// scripts with the charts' library: deflated, as base64. Browsers unpack only asynchronously.
(function() {
'use strict';
// The bytes that report::deflated() packed, from base64.
window.noonmarkUnpack = async function(base64) {
  var packed = Uint8Array.from(atob(base64), function(c) {
    return c.charCodeAt(0);
  });
  var stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
};
// In a browser that cannot unpack, the page is what readers without JavaScript get.
function withoutScripts() {
  document.documentElement.className = 'no-js';
  document.querySelectorAll('noscript').forEach(function(n) {
    n.outerHTML = n.textContent;
  });
  var said = document.createElement('p');
  said.textContent = 'This browser cannot unpack the data of the charts, so they are not drawn. Use Chrome 80, ' +
      'Firefox 113, Safari 16.4 or a later one.';
  document.querySelector('main').prepend(said);
}
// Promises the text of a block.
function textOf(id) {
  var block = document.getElementById(id);
  return block.hasAttribute('data-packed') ? noonmarkUnpack(block.textContent).then(function(bytes) {
    return new TextDecoder().decode(bytes);
  }) :
                                             Promise.resolve(block.textContent);
}
// Runs the page's scripts, which are a function of the data. noonmarkReady ends after that.
window.noonmarkStart = function() {
  window.noonmarkReady = !('DecompressionStream' in window) ?
      Promise.resolve(withoutScripts()) :
      Promise.all([textOf('noonmark-code'), textOf('noonmark-data')]).then(function(texts) {
        var code = document.createElement('script');
        code.textContent = texts[0];
        document.head.append(code);
        noonmarkRun(JSON.parse(texts[1]));
      });
};
})();
