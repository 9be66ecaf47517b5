"""Edited copies of a capture, through RenderDoc's XML form. Its replay can replace shaders, but no contents of a texture,
and a shader of the map may be the picture's as well; a copy without the map's draws is right in every case.
"""
import os
import re
import subprocess

from replay import Capture, Refusal

COUNTS = re.compile(r'(<u?int name="(?:count|indexCount|vertexCount|drawCount|instanceCount)"[^>]*>)\d+')
CLEARS = ('glClear', 'glClearBufferfv', 'glClearBufferfi', 'vkCmdBeginRenderPass')
FLOAT, INTEGER = re.compile(r'(<float [^>]*>)[^<]*'), re.compile(r'(<u?int [^>]*>)[^<]*')
CLEAR = '''<chunk id="1696" name="glClearBufferfv" length="48" threadID="1" timestamp="1" duration="1">
<ResourceId name="framebuffer" typename="GLResource" width="8">{framebuffer}</ResourceId>
<enum name="buffer" typename="RDCGLenum" string={buffer}</enum>
<int name="drawbuffer" typename="int32_t" width="4" important="true">0</int>
<array name="value" important="true">{values}</array>
<array name="DebugMessages" typename="DebugMessage" hidden="true" />
</chunk>
'''


class Copies:
    def __init__(self, path, folder):
        self.folder = folder
        self._convert(path, 'base.zip.xml', 'zip.xml')
        text = open(self._file('base.zip.xml'), encoding='utf-8', errors='surrogateescape').read()
        start, end = text.index('<chunk id'), text.index('</chunks>')
        self.head, self.tail = text[:start], text[end:]
        self.chunks = re.findall(r'<chunk id=[^>]*/>\s*|<chunk id=.*?</chunk>\s*', text[start:end], re.S)

    def _file(self, name):
        return os.path.join(self.folder, name)

    def _convert(self, path, name, form):
        done = subprocess.run(['renderdoccmd', 'convert', '-f', path, '-o', self._file(name), '-c', form],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        if done.returncode:
            raise Refusal(f'renderdoccmd convert ends with {done.returncode}: {done.stderr.decode(errors="replace").strip()[-200:]}')

    def call(self, chunk):
        return re.match(r'<chunk id="\d+" name="([^"]*)"', self.chunks[chunk]).group(1)

    def without(self, draws):
        """The edits that let the draws draw nothing. They stay, so the numbers of events stay."""
        edits = {}
        for draw in draws:
            edits[draw.chunk], changed = COUNTS.subn(r'\g<1>0', self.chunks[draw.chunk])
            if not changed:
                raise Refusal(f'draw {draw.event} takes its vertices from {self.call(draw.chunk)}, which cannot be emptied')
        return edits

    def cleared(self, drawn, clears, colour, value):
        """(edits, calls put in): the pass's map is cleared to `value` where this frame clears it last before drawing."""
        first, outputs = min(d.chunk for d in drawn.draws), {o[0] for o in drawn.outputs}
        mine = [c for c, z, o in clears
                if c < first and (z == drawn.depth[0] if drawn.depth else outputs & set(o)) and self.call(c) in CLEARS]
        if not mine:
            raise Refusal(f'the map of {drawn.name} is not cleared in this frame, so it keeps what earlier frames drew; move '
                          'the light a little while the frame is captured')
        chunk, text = mine[-1], self.chunks[mine[-1]]
        if self.call(chunk) == 'glClear':
            bound = [re.search(r'name="framebuffer"[^>]*>(\d+)<', self.chunks[k]).group(1)
                     for k in range(chunk) if self.call(k) == 'glBindFramebuffer' and 'READ' not in self.chunks[k]][-1]
            values = f'<float typename="float" width="4">{value}</float>' * (4 if colour else 1)
            buffer = '"GL_COLOR">6144' if colour else '"GL_DEPTH">6145'
            return {chunk: text + CLEAR.format(framebuffer=bound, buffer=buffer, values=values)}, 1
        start, mark, values = text.rpartition('<array name="pClearValues">')
        if mark:  # Vulkan's is a union: each of its members is written, one over the other, so all are set alike
            values = INTEGER.sub(r'\g<1>' + ('1065353216' if value == 1 else '0'), values)
        return {chunk: start + mark + FLOAT.sub(rf'\g<1>{value}', values)}, 0

    def open(self, edits):
        """An opened capture with the edited calls."""
        with open(self._file('copy.zip.xml'), 'w', encoding='utf-8', errors='surrogateescape') as f:
            f.write(self.head)
            f.writelines(edits.get(i, c) for i, c in enumerate(self.chunks))
            f.write(self.tail)
        if not os.path.exists(self._file('copy.zip')):
            os.link(self._file('base.zip'), self._file('copy.zip'))
        self._convert(self._file('copy.zip.xml'), 'copy.rdc', 'rdc')
        return Capture(self._file('copy.rdc'))
