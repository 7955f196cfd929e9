"""How a servo without an ID of its own asks for one (2.3, Allocation)."""

from transfer import ALLOCATION, Head

PRIORITY = 24
PARTS = (slice(0, 6), slice(6, 12), slice(12, 16))
REQUEST_S, FOLLOW_UP_S = (0.6, 1.0), (0.0, 0.4)


class Allocatee:
    """`send(head, payload)`, `later(seconds, what)`: of the servo. `got(node_id)` ends it."""

    def __init__(self, servo, got):
        self._servo, self._got = servo, got
        self._turn = 0  # what was to be sent before the last answer is not sent any more
        self._ask(0, REQUEST_S)

    def _ask(self, known, between):
        self._turn += 1
        turn = self._turn
        self._servo.later(self._servo.chance.uniform(*between),
                          lambda: self._send(known) if turn == self._turn else None)

    def _send(self, known):
        part = self._servo.unique_id[PARTS[known // 6]]
        head = Head(PRIORITY, False, ALLOCATION, 0)
        discriminator = self._servo.chance.getrandbits(14)
        self._servo.send_anonymous(head.can_id() | discriminator << 10,
                                   bytes([known == 0]) + part)
        self._ask(0, REQUEST_S)  # unless an answer comes

    def hear(self, source, payload):
        """A message of anybody: who else asks, or an answer, is let finish first."""
        known = payload[1:]
        if source == 0 or not known or self._servo.unique_id[:len(known)] != known:
            self._ask(0, REQUEST_S)
        elif len(known) < 16:
            self._ask(len(known), FOLLOW_UP_S)
        elif payload[0] >> 1:
            self._turn += 1
            self._got(payload[0] >> 1)
