#!/usr/bin/python3
"""capture.py FRAME.rdc OUT: a capture of RenderDoc as frames for `noonmark judge`, which OUT/capture.json lists.

Exit codes: 0 frames are written, 2 the command or its file, 3 the capture cannot be judged, 4 a package is missing.
A replay runs the captured calls in this machine's driver. So it runs in a child without a network or a display, which writes
only into OUT, with a limit of memory and time, and ends with this process.
"""
import argparse
import ctypes
import multiprocessing
import os
import resource
import shutil
import signal
import struct
import sys

MEMORY, SECONDS = 16 << 30, 1200
CLONE_NEWUSER, CLONE_NEWNET, PR_SET_PDEATHSIG, PR_SET_NO_NEW_PRIVS = 0x10000000, 0x40000000, 1, 38
LANDLOCK_CREATE, LANDLOCK_ADD, LANDLOCK_RESTRICT = 444, 445, 446
WRITES = 0x1ff2 | 1 << 14  # all that changes files, and truncation; reading stays free


def confine(folder):
    """What the kernel offers of it."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
    for limit, most in ((resource.RLIMIT_AS, MEMORY), (resource.RLIMIT_CPU, SECONDS), (resource.RLIMIT_CORE, 0)):
        hard = resource.getrlimit(limit)[1]
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(limit, (most, most))
    if libc.unshare(CLONE_NEWNET) != 0:
        libc.unshare(CLONE_NEWUSER | CLONE_NEWNET)
    version = libc.syscall(LANDLOCK_CREATE, None, 0, 1)
    if version > 0:
        writes = WRITES if version >= 3 else WRITES & 0x1fff
        rules = libc.syscall(LANDLOCK_CREATE, struct.pack('Q', writes), 8, 0)
        for place in (folder, '/dev'):
            libc.syscall(LANDLOCK_ADD, rules, 1, struct.pack('=Qi', writes, os.open(place, os.O_PATH | os.O_CLOEXEC)), 0)
        libc.syscall(LANDLOCK_RESTRICT, rules, 0)


def failed(code, subject, why):
    print(f'noonmark: {subject}: {why}', file=sys.stderr)
    return code


def replay(options):
    """In the child. It ends without Python's ending, nor RenderDoc's, which can wait for ever."""
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    confine(options.out)
    sys.stdout.reconfigure(line_buffering=True)
    os.environ.pop('DISPLAY', None)  # RenderDoc replays OpenGL through EGL then
    places = ('HOME', 'TMPDIR', 'XDG_RUNTIME_DIR', 'XDG_CACHE_HOME')
    os.environ |= ({'LIBGL_ALWAYS_SOFTWARE': '1', 'LP_NUM_THREADS': '2'} | os.environ | {'EGL_PLATFORM': 'surfaceless'}
                   | dict.fromkeys(places, options.scratch))
    try:
        import read_capture
        read_capture.read(options)
        os._exit(0)
    except ModuleNotFoundError as why:
        os._exit(failed(4, f'captures need the module {why.name}', f"install Debian's package python3-{why.name} with apt"))
    except read_capture.Refusal as why:
        os._exit(failed(3, options.capture, why))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('capture', type=os.path.abspath)
    parser.add_argument('out', type=os.path.abspath)
    parser.add_argument('--light', type=int, default=0, help='only the light of this number, from 1')
    parser.add_argument('--filter', help='of the lookup: none, hardware, box3, box5 or box7; without it the one that fits')
    parser.add_argument('--bias', type=float, help='of the lookup, constant, in window depth; without it the one that fits')
    options = parser.parse_args()
    options.scratch = os.path.join(options.out, '.noonmark-scratch')
    try:
        with open(options.capture, 'rb') as f:
            if f.read(4) != b'RDOC':
                raise OSError('no capture of RenderDoc (its first bytes are not RDOC)')
        shutil.rmtree(options.scratch, ignore_errors=True)  # of a run that was killed
        os.makedirs(options.scratch)
    except OSError as why:
        return failed(2, options.capture, why.strerror or why)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that the scratch folder ends with this process
    try:
        for _ in range(2):  # one replay of a thousand ends in getenv, which RenderDoc and Mesa call while others change the environment
            child = multiprocessing.get_context('fork').Process(target=replay, args=[options])
            child.start()
            child.join(2 * SECONDS)
            if child.exitcode != -signal.SIGSEGV:
                break
    finally:  # after its time, too, and when this process is ended
        child.kill()
        child.join()
        shutil.rmtree(options.scratch, ignore_errors=True)
    limits = f'the driver, or its limits of {MEMORY >> 30} GiB and {SECONDS} s'
    return child.exitcode if child.exitcode >= 0 else failed(
        3, options.capture, f'the replay ended by signal {-child.exitcode} ({limits})')


if __name__ == '__main__':
    sys.exit(main())
