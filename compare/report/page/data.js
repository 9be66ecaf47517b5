// The page's data block, and the start of the scripts that need it. compare/report/page_parts.cpp packs a large block:
// deflated, as base64. Browsers unpack only asynchronously, so a page with a packed block starts a little later.
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
// Calls run(data) once the data are there. noonmarkReady ends after that.
window.noonmarkStart = function(run) {
  var block = document.getElementById('noonmark-data');
  if (!block.hasAttribute('data-packed'))
    window.noonmarkReady = Promise.resolve(run(JSON.parse(block.textContent)));
  else if (!('DecompressionStream' in window))
    window.noonmarkReady = Promise.resolve(withoutScripts());
  else
    window.noonmarkReady = noonmarkUnpack(block.textContent).then(function(bytes) {
      run(JSON.parse(new TextDecoder().decode(bytes)));
    });
};
})();
