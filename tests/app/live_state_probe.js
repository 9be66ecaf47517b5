// The controls and the address of the live page, as tests/app/live_agreement_test.cpp asks for them: what is moved, and what the
// page then holds.
noonmarkLive.ready
    .then(async () => {
      // The headless browser's virtual time runs out while a frame waits for the software renderer.
      window.requestAnimationFrame = draw => setTimeout(draw, 16);
      const wait = ms => new Promise(go => setTimeout(go, ms));
      const control = name => document.getElementById('value-' + name);
      const slider = name => control(name).parentElement.querySelector('input[type=range]');
      // As a link to it does. A real navigation would end the virtual time of the headless browser.
      const goTo = fragment => {
        history.replaceState(null, '', fragment);
        dispatchEvent(new HashChangeEvent('hashchange'));
      };
      const seen = async () => {
        await wait(400);  // the page writes its address 200 ms after the last change
        const picture = document.getElementById('frame'),
              pixels = picture.getContext('2d').getImageData(0, 0, picture.width, picture.height).data;
        let sum = 0;
        for (let i = 0; i < pixels.length; ++i) sum = (31 * sum + pixels[i]) % 4294967291;
        return {
          address: Object.fromEntries(new URLSearchParams(location.hash.slice(1))),
          offset: control('bias.normal_offset').value,
          constant: control('bias.constant').value,
          filter: control('filter').value,
          format: control('map.format').value,
          slider: Number(slider('bias.normal_offset').value),
          says: document.getElementById('says').textContent,
          picture: sum
        };
      };
      const saw = {began: await seen()};
      slider('bias.normal_offset').value = 0.4;  // of 0 ... 5 texels
      slider('bias.normal_offset').dispatchEvent(new Event('input', {bubbles: true}));
      saw.moved = await seen();
      control('map.format').value = '16';
      control('map.format').dispatchEvent(new Event('change', {bubbles: true}));
      saw.chosen = await seen();
      goTo('#bias.constant=0.2&filter.kind=box&filter.size=5');
      saw.addressed = await seen();
      goTo('#bias.constant=moon');
      saw.refused = await seen();
      document.getElementById('reset').click();
      saw.reset = await seen();
      saw.errors = errors;
      leave(saw);
    })
    .catch(error => leave({errors: [String(error)]}));
