"""The package `sunder_tear`: the add-on's own copy, as it is released, or an installed one."""
import pathlib

if (pathlib.Path(__file__).parent / 'sunder_tear').is_dir():
    from . import sunder_tear
else:
    import sunder_tear

__all__ = ['sunder_tear']
