"""The shaft of a servo: where it is, and what turns it (4.1 to 4.6, 4.13, 4.17 to 4.19).

It has a greatest speed and no mass: what it did is reckoned when somebody looks. Angles are in
tenths of a degree, as registers have them."""

NOT_ACTIVE = 555555555
ANGLE, SPEED, TORQUE = COMMANDS = (0x00, 0x01, 0x02)
OUTPUT, REVERSE, EXTENDED, SPEED_TORQUE = 0x20, 0x23, 0x24, 0x25
TIMEOUT_ACTION, TIMEOUT = 0x26, 0x27
MEASURED = (0x08, 0x09, 0x0A)
HOLD = 0
TURN = 3600
GREATEST_RPM = 60
RPM = TURN / 60  # in tenths of a degree per second
EFFORT = 15  # % of torque while it turns; unproven


def within_a_turn(angle):
    """-1800 to 1799."""
    return (angle + TURN / 2) % TURN - TURN / 2


class Shaft:
    """`now()`: seconds. `ram`, wherever it is asked for: the registers of the moment."""

    def __init__(self, now, angle=0):
        self._now = now
        self._seen = now()
        self._angle = angle  # as without 0x23
        self._commanded = None  # when it was last; None: not since it started
        self._rpm = 0.0

    def start(self):
        """Torque is where the shaft is, and what lies beyond half a turn is forgotten (4.1)."""
        self._angle = within_a_turn(self._angle)
        self._seen, self._commanded, self._rpm = self._now(), None, 0.0

    def command(self):
        """Of 0x00 to 0x02, or 0x20: the communication timeout begins anew."""
        self._commanded = self._now()

    def angle(self, ram):
        return round(self._sign(ram) * self._angle)

    def look(self, ram):
        """What 0x08 to 0x0A show now."""
        now = self._now()
        end = min(now, self._driven_until(ram))
        if end > self._seen:
            self._turn(ram, end - self._seen)
        if now > end:
            self._rpm = 0.0
        self._seen = now
        if ram[ANGLE] == NOT_ACTIVE and not ram[EXTENDED]:
            self._angle = within_a_turn(self._angle)
        effort = ram[TORQUE] if ram[TORQUE] != NOT_ACTIVE and now <= end else 0
        if not effort and self._rpm:
            effort = EFFORT if self._rpm > 0 else -EFFORT
        return dict(zip(MEASURED, (self.angle(ram), round(self._rpm), effort)))

    @staticmethod
    def _sign(ram):
        return -1 if ram[REVERSE] else 1

    def _driven_until(self, ram):
        if self._commanded is None or ram[OUTPUT]:
            return self._seen
        if ram[TIMEOUT_ACTION] == HOLD:
            return float("inf")
        return self._commanded + ram[TIMEOUT] / 1000

    def _turn(self, ram, seconds):
        sign = self._sign(ram)
        if ram[ANGLE] == NOT_ACTIVE:
            self._rpm = self._wanted(ram)
            self._angle += sign * self._rpm * RPM * seconds
            return
        low, high = ram[0x39], ram[0x38]
        way = min(max(ram[ANGLE], low), high) - sign * self._angle
        reach = self._most(ram, way > 0) * RPM * seconds
        arrives = abs(way) <= reach
        self._angle += sign * (way if arrives else reach if way > 0 else -reach)
        self._rpm = 0.0 if arrives else reach / RPM / seconds * (1 if way > 0 else -1)

    def _wanted(self, ram):
        """In rpm: a shaft without a load turns as fast as its torque is great."""
        if ram[SPEED] != NOT_ACTIVE:
            most = self._most(ram, ram[SPEED] > 0)
            return min(max(ram[SPEED], -most), most)
        torque = min(max(ram[TORQUE], ram[0x3D]), ram[0x3C])
        return GREATEST_RPM * torque / 100

    @staticmethod
    def _most(ram, clockwise):
        if not ram[SPEED_TORQUE]:
            return GREATEST_RPM
        return min(GREATEST_RPM, ram[0x3A] if clockwise else -ram[0x3B])
