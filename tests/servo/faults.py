"""What goes wrong with a servo: the faults of the campaign's scenarios, and losses by number."""

KINDS = ("any", "node_info", "read", "write", "opcode", "restart")


class Faults:
    """`given`: as in a scenario, and "lost": [{"to": "write", "number": 1, "what": "answer"}, …],
    where "what" may be "request", too: then nothing is obeyed; or "restart": that is all it does."""

    def __init__(self, given):
        self._given = dict(given)
        self._counts = dict.fromkeys(KINDS, 0)

    def has(self, name):
        return bool(self._given.get(name))

    def value(self, name, default=None):
        return self._given.get(name, default)

    def take(self, name):
        """Whether one more of so many is due."""
        left = self._given.get(name, 0)
        if left:
            self._given[name] = left - 1
        return bool(left)

    def once(self, name):
        return self._given.pop(name, None)

    def count(self, kind):
        """A request of this kind has come: its numbers."""
        for each in ("any", kind):
            self._counts[each] += 1
        return {each: self._counts[each] for each in ("any", kind)}

    def is_lost(self, what, numbers):
        return any(entry["what"] == what and self._means(entry, numbers)
                   for entry in self._given.get("lost", []))

    def restarts_after(self, numbers):
        return any(self._means(entry, numbers)
                   for entry in self._given.get("restart_after_answer", []))

    def restarts_instead(self, numbers):
        return self._given.get("restart_instead_of_answer", 0) == numbers["any"]

    @staticmethod
    def _means(entry, numbers):
        return numbers.get(entry.get("to", "any")) == entry.get("number", 1)
