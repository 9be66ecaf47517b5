// Unpacks the page's scripts and shaders and starts them. live_page.cpp packs them, because they are most of the file.
// window.noonmarkLive: `ready` ends when the first picture is drawn; measure(state) then gives the metrics of any state
// (fractions by the names of compare/results/metrics.cpp), for tests and for a console.
window.noonmarkLive = {
  ready: (async function() {
    const says = document.getElementById('says');
    try {
      if (!window.DecompressionStream) throw new Error('this browser cannot unpack it; use Chrome 80, Firefox 113, Safari 16.4 or a later one');
      const code = JSON.parse(new TextDecoder().decode(await noonmarkUnpack(document.getElementById('live-code').textContent)));
      window.noonmarkLive.shaders = code.shaders;
      const script = document.createElement('script');
      script.textContent = code.script;
      document.body.append(script);
      await window.noonmarkLive.start();
    } catch (error) {
      says.className = 'fails';
      says.textContent = 'The page cannot draw: ' + error.message + '.';
      throw error;
    }
  })()
};
