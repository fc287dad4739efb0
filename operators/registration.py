"""Registers the modules of a package by their names, and unregisters them in reverse order.

A module declares what it registers, all of it optional:

- ``classes``: to be registered, in their order;
- ``pointers``: (type of Blender's, name of the property, property group);
- ``menus``: (menu of Blender's, function that draws its entry);
- ``handlers``: (list of `bpy.app.handlers`, function that it calls);
- ``register()`` and ``unregister()``: whatever else it adds, such as keymaps and timers.
"""

from importlib import import_module

import bpy


class Registration:
    """The modules of a package that have something for Blender.

    Parameters
    ----------
    package : str
    names : sequence of str
        Of the modules, relative to the package, in the order in which they are registered.
    """

    def __init__(self, package, names):
        self._package, self._names = package, names
        self._undo = []

    def register(self):
        """Register everything; where something fails, take out again what was registered before it."""
        try:
            for name in self._names:
                self._add(import_module(f".{name}", self._package))
        except BaseException:
            self.unregister()
            raise

    def unregister(self):
        """Unregister everything; an error keeps nothing else from being unregistered, and is raised at the end."""
        failed = None
        while self._undo:
            take_out, *what = self._undo.pop()
            try:
                take_out(*what)
            except Exception as error:
                failed = failed or error
        if failed is not None:
            raise failed

    def _add(self, module):
        for cls in getattr(module, "classes", ()):
            bpy.utils.register_class(cls)
            self._undo.append((bpy.utils.unregister_class, cls))
        for owner, name, group in getattr(module, "pointers", ()):
            setattr(owner, name, bpy.props.PointerProperty(type=group, override={"LIBRARY_OVERRIDABLE"}))
            self._undo.append((delattr, owner, name))
        for menu, draw in getattr(module, "menus", ()):
            menu.append(draw)
            self._undo.append((menu.remove, draw))
        for handlers, function in getattr(module, "handlers", ()):
            handlers.append(function)
            self._undo.append((handlers.remove, function))
        if hasattr(module, "unregister"):
            self._undo.append((module.unregister,))
        if hasattr(module, "register"):
            module.register()
