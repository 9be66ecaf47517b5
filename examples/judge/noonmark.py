"""Judges a frame's shadows from Python: numpy arrays in, a dictionary out.

    import noonmark
    scene = noonmark.Scene("room.glb")
    verdict = scene.judge(visibility, clip_from_world, light_direction=(-0.4, -0.8, -0.3))
    assert verdict["frame_acne"] < 0.0005, verdict

The library is libnoonmark.so.0 (frames/noonmark.h); NOONMARK_LIBRARY names another file. Only numpy is needed.
"""
import ctypes as c
import os

import numpy as np


class Frame(c.Structure):
    """struct noonmark_frame of frames/noonmark.h."""
    _fields_ = [("struct_size", c.c_size_t), ("width", c.c_int32), ("height", c.c_int32),
                ("visibility", c.POINTER(c.c_float)), ("positions", c.POINTER(c.c_float)),
                ("clip_from_world", c.c_double * 16), ("depth_0_to_1", c.c_int32), ("reversed", c.c_int32),
                ("y_down", c.c_int32), ("light_kind", c.c_int32), ("light_position", c.c_double * 3),
                ("light_direction", c.c_double * 3), ("light_cone_deg", c.c_double),
                ("light_angular_diameter_deg", c.c_double), ("light_radius_m", c.c_double), ("edge_pixels", c.c_double),
                ("edge_m", c.c_double), ("contact_m", c.c_double), ("accept", c.c_char_p),
                ("normalised", c.c_int64)]


def _library():
    library = c.CDLL(os.environ.get("NOONMARK_LIBRARY", "libnoonmark.so.0"))
    for name, result, arguments in [
            ("scene_load", c.c_void_p, [c.c_char_p]), ("scene_status", c.c_int, [c.c_void_p]),
            ("scene_message", c.c_char_p, [c.c_void_p]), ("scene_free", None, [c.c_void_p]),
            ("frame_init", None, [c.POINTER(Frame), c.c_size_t]), ("judge", c.c_void_p, [c.c_void_p, c.POINTER(Frame)]),
            ("status", c.c_int, [c.c_void_p]), ("number", c.c_double, [c.c_void_p, c.c_char_p]),
            ("number_name", c.c_char_p, [c.c_void_p, c.c_size_t]), ("classes", c.POINTER(c.c_uint8), [c.c_void_p]),
            ("truth", c.POINTER(c.c_float), [c.c_void_p]), ("message", c.c_char_p, [c.c_void_p, c.c_size_t]),
            ("verdict_free", None, [c.c_void_p])]:
        function = getattr(library, "noonmark_" + name)
        function.restype, function.argtypes = result, arguments
    return library


_lib = _library()


class Refused(Exception):
    """The call, the scene or the delivery is wrong; the text says why."""


def _all(function, verdict):
    texts = []
    while (text := function(verdict, len(texts))) is not None:
        texts.append(text.decode())
    return texts


class Scene:
    """A built-in scene, or a .gltf or .glb file."""

    def __init__(self, name):
        self._scene = _lib.noonmark_scene_load(os.fsencode(name))
        if _lib.noonmark_scene_status(self._scene) != 0:
            raise Refused(_lib.noonmark_scene_message(self._scene).decode())

    def __del__(self):
        if getattr(self, "_scene", None):
            _lib.noonmark_scene_free(self._scene)

    def judge(self, visibility, clip_from_world, positions=None, accept=(), **fields):
        """visibility: height x width, 1 lit, 0 shadowed, -1 or NaN without a surface. clip_from_world: 4 x 4, for column
        vectors. positions: height x width x 3, or None. fields: the other fields of struct noonmark_frame by name."""
        frame = Frame()
        _lib.noonmark_frame_init(c.byref(frame), c.sizeof(frame))
        lit = np.ascontiguousarray(visibility, np.float32)
        frame.height, frame.width = lit.shape
        frame.visibility = lit.ctypes.data_as(c.POINTER(c.c_float))
        if positions is not None:
            places = np.ascontiguousarray(positions, np.float32)
            if places.shape != lit.shape + (3,):
                raise Refused("positions are height x width x 3")
            frame.positions = places.ctypes.data_as(c.POINTER(c.c_float))
        frame.clip_from_world[:] = np.asarray(clip_from_world, float).T.ravel()
        frame.accept = ",".join(accept).encode()
        for name, value in fields.items():
            if name not in dict(Frame._fields_):
                raise Refused(f"there is no field '{name}'")
            if name.startswith(("light_position", "light_direction")):
                getattr(frame, name)[:] = value
            else:
                setattr(frame, name, value)
        verdict = _lib.noonmark_judge(self._scene, c.byref(frame))
        try:
            messages = _all(_lib.noonmark_message, verdict)
            if _lib.noonmark_status(verdict) != 0:
                raise Refused("; ".join(m for m in messages if "FAILED" in m) or messages[0])
            result = {name: _lib.noonmark_number(verdict, name.encode())
                      for name in _all(_lib.noonmark_number_name, verdict)}
            result["messages"] = messages
            result["classes"] = np.ctypeslib.as_array(_lib.noonmark_classes(verdict), lit.shape).copy()
            result["truth"] = np.ctypeslib.as_array(_lib.noonmark_truth(verdict), lit.shape).copy()
            return result
        finally:
            _lib.noonmark_verdict_free(verdict)
