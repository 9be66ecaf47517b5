// Links Vega's CommonJS modules, as Debian packages them, into one object with the functions that the charts need.
var noonmarkVega = (function() {
  'use strict';
  var sources = {}, loaded = {};
  function require(name) {
    if (name === 'vega-selections') name = 'vega-selection';  // vega-functions requires it by this name
    if (!loaded[name]) {
      if (!sources[name]) throw new Error('no module ' + name);
      var module = {exports: (loaded[name] = {})};
      sources[name](module.exports, module, require);
    }
    return loaded[name];
  }
  return {
    define: function(name, source) {
      sources[name] = source;
    },
    // Draws a specification into an element and returns the view. Expressions run in Vega's interpreter, without eval.
    draw: function(specification, element) {
      var dataflow = require('vega-dataflow');
      ['vega-transforms', 'vega-view-transforms', 'vega-encode'].forEach(function(name) {
        Object.assign(dataflow.transforms, require(name));
      });
      var runtime = require('vega-parser').parse(specification, null, {ast: true});
      var View = require('vega-view').View;
      return new View(runtime, {expr: require('vega-interpreter').expressionInterpreter, renderer: 'svg', logLevel: 1})
          .tooltip(function() {})
          .initialize(element)
          .run();
    }
  };
})();
