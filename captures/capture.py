#!/usr/bin/python3
"""capture.py FRAME.rdc OUT: a capture of RenderDoc as frames for `noonmark judge`.

Exit codes: 0 frames are written, 2 the command or its file, 3 the capture cannot be judged, 4 a package is missing.
A replay runs the captured calls in this machine's driver. So it runs in a child without a network, which writes only into
OUT, with a limit of memory and time; display and child end with this process.
"""
import argparse
import ctypes
import glob
import importlib.util
import os
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile

PACKAGES = {'renderdoc': 'python3-renderdoc', 'numpy': 'python3-numpy'}
CRASHES = (-signal.SIGSEGV, -signal.SIGABRT, -signal.SIGBUS, -signal.SIGILL)
MEMORY, SECONDS = 16 << 30, 1200
CLONE_NEWUSER, CLONE_NEWNET, PR_SET_PDEATHSIG, PR_SET_NO_NEW_PRIVS = 0x10000000, 0x40000000, 1, 38
LANDLOCK_CREATE, LANDLOCK_ADD, LANDLOCK_RESTRICT = 444, 445, 446
WRITES = 0x1ff2 | 1 << 14  # all that changes files, and truncation; reading stays free


def missing():
    found = [package for module, package in PACKAGES.items() if importlib.util.find_spec(module) is None]
    found += [p for program, p in (('renderdoccmd', 'renderdoc'),) if not shutil.which(program)]
    return found + (['xvfb'] if not os.environ.get('DISPLAY') and not shutil.which('Xvfb') else [])


def confine(folder):
    """What the kernel offers of it; runs in the child before the replay starts."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if libc.unshare(CLONE_NEWNET) != 0:
        libc.unshare(CLONE_NEWUSER | CLONE_NEWNET)
    version = libc.syscall(LANDLOCK_CREATE, None, 0, 1)
    if version <= 0:
        return
    writes = WRITES if version >= 3 else WRITES & 0x1fff
    rules = libc.syscall(LANDLOCK_CREATE, struct.pack('Q', writes), 8, 0)
    for place in (folder, '/dev'):
        opened = os.open(place, os.O_PATH)
        libc.syscall(LANDLOCK_ADD, rules, 1, struct.pack('=Qi', writes, opened), 0)
        os.close(opened)
    libc.syscall(LANDLOCK_RESTRICT, rules, 0)


def with_display(environment):
    """(environment, process): a display of its own where there is none, because RenderDoc's replay of OpenGL needs one."""
    if environment.get('DISPLAY'):
        return environment, None
    read, write = os.pipe()
    parent_death = lambda: ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    server = subprocess.Popen(['Xvfb', '-displayfd', str(write), '-screen', '0', '64x64x24', '-nolisten', 'tcp'], pass_fds=[write],
                              preexec_fn=parent_death, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write)
    number = os.read(read, 16).decode().strip()
    if not number:
        sys.exit('noonmark: Xvfb does not start, and RenderDoc replays OpenGL on a display only')
    return environment | {'DISPLAY': ':' + number}, server


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('capture')
    parser.add_argument('out')
    parser.add_argument('--light', type=int, default=0, help='only the light of this number, from 1')
    parser.add_argument('--casters', choices=('union', 'camera', 'map'), default='union')
    parser.add_argument('--filter', choices=('none', 'hardware', 'box3', 'box5', 'box7'), help='of the lookup; without it the one that fits')
    parser.add_argument('--bias', type=float, help='of the lookup, constant, in window depth; without it the one that fits')
    parser.add_argument('--inside', action='store_true', help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.inside:
        import read_capture
        read_capture.main(options)
    if missing():
        print(f'noonmark: captures need these packages of Debian: {" ".join(missing())}; install them with apt', file=sys.stderr)
        return 4
    try:
        if not os.path.isfile(options.capture) and os.path.exists(options.capture):
            raise OSError('not a file')
        with open(options.capture, 'rb') as f:
            if f.read(4) != b'RDOC':
                raise OSError('no capture of RenderDoc (its first bytes are not RDOC)')
        os.makedirs(options.out, exist_ok=True)
    except OSError as why:
        print(f'noonmark: {options.capture}: {why.strerror or why}', file=sys.stderr)
        return 2
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that display and scratch folder end with this process
    folder = os.path.abspath(options.out)
    environment, server = with_display(dict(os.environ))
    for old in glob.glob(os.path.join(glob.escape(folder), '.noonmark-scratch-*')):
        shutil.rmtree(old, ignore_errors=True)  # of a run that was killed
    scratch = tempfile.mkdtemp(prefix='.noonmark-scratch-', dir=folder)
    environment |= {'LIBGL_ALWAYS_SOFTWARE': environment.get('LIBGL_ALWAYS_SOFTWARE', '1'), 
                    'HOME': scratch, 'TMPDIR': scratch, 'XDG_RUNTIME_DIR': scratch, 'XDG_CACHE_HOME': scratch, 'LP_NUM_THREADS': '2'}
    command = [sys.executable, os.path.abspath(__file__), os.path.abspath(options.capture), folder, '--inside',
               '--light', str(options.light), '--casters', options.casters,
               *(f'--{k}={v}' for k, v in (('filter', options.filter), ('bias', options.bias)) if v is not None)]
    try:
        for tried in (1, 2):
            child = subprocess.Popen(command, env=environment, preexec_fn=lambda: confine(folder))
            code = child.wait(timeout=2 * SECONDS)
            if code not in CRASHES or tried == 2:
                break
            print(f'the replay crashed (signal {-code}); it is tried once more', flush=True)  # one of 130 did, in the driver
    except subprocess.TimeoutExpired:
        child.kill()
        code = -signal.SIGKILL
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
        if server:
            server.terminate()
            server.wait()
    if code < 0:
        print(f'noonmark: {options.capture}: the replay ended by signal {-code} (the driver, or its limits of {MEMORY >> 30} GiB and '
              f'{SECONDS} s)', file=sys.stderr)
        return 3
    return code


if __name__ == '__main__':
    sys.exit(main())
