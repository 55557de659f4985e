"""What failing calls raise."""
from typing import Optional

_NONE = 0xFFFFFFFF


class SunderError(Exception):
    """A call failed, and changed nothing.

    code: the number of the status; name: its name ("index_out_of_range"); text: what is wrong and where; index: the element of
    which the text speaks, or None.
    """

    def __init__(self, code: int, name: str, text: str, index: int = _NONE):
        super().__init__(f'{text} ({name})')
        self.code = code
        self.name = name
        self.text = text
        self.index: Optional[int] = None if index == _NONE else index


class StaleView(SunderError):
    """Borrowed arrays were used, or the scene was changed, while the other was not allowed."""

    def __init__(self, text: str):
        super().__init__(-1, 'stale_view', text)
