"""Kills a command with -9 right after a frame that it sends."""

import os
import select
import signal
import socket
import struct
import threading

import bench

SEND = 0x4D534C42 + 4  # include/blactl/can/sim_wire.hpp: a frame for the bus
LARGEST = 64


class GoBetween:
    """Between one command and the simulator; kills it when it has sent so many frames."""

    def __init__(self, folder, frames):
        self.interface = os.path.join(folder, "between")
        self._server = os.path.join(folder, "blactl", "sim")
        self._frames, self.passed = frames, 0
        self._listening = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._listening.bind(self.interface)
        self._listening.listen(1)
        self._process = None

    def run(self, command):
        """The command's status, output and errors."""
        self._process = command
        passing = threading.Thread(target=self._pass, daemon=True)
        passing.start()
        out, err = command.communicate(timeout=bench.PATIENCE_S)
        passing.join(timeout=bench.PATIENCE_S)
        os.remove(self.interface)
        self._listening.close()
        return command.returncode, out, err

    def _pass(self):
        client, _ = self._listening.accept()
        with client, socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as server:
            server.connect(self._server)
            ends = {client: server, server: client}
            while True:
                for end in select.select(list(ends), [], [])[0]:
                    try:
                        message = end.recv(LARGEST)
                    except ConnectionError:
                        return
                    if not message:
                        return
                    ends[end].send(message)
                    if end is client and struct.unpack_from("I", message)[0] == SEND:
                        self.passed += 1
                        if self.passed == self._frames:
                            self._process.send_signal(signal.SIGKILL)
                            self._process.wait()
                            return
