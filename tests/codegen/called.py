"""Functions of a text of C, called from Python."""

import ctypes

from piezo_sym.run.engine.compiler import build, compilers


def built(folder, arities, *texts):
    """Return a library of some texts of C, whose functions take so many numbers, and return one."""
    (folder / "called.c").write_text("\n".join(texts))
    build(next(compilers()), ("-shared", "-fPIC"), folder / "called.c", folder / "called.so")
    library = ctypes.CDLL(str(folder / "called.so"))
    for name, arity in arities.items():
        function = getattr(library, name)
        function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double] * arity
    return library
