"""From an engine's laws and the kernel's modules to compiled code.

Three facts to begin with:

- **Imports are stripped.** A composed module is the text of our modules without their docstrings
  and without ``from saleg...`` lines; it imports nothing of ours.
- **All parts share one namespace.** A name defined in two of them is refused, and what a law brings
  along (helpers, constants) gets a prefix of its slot.
- **This is the order:** what laws are shown (``laws/arguments``), what of the kernel needs no law,
  the slots (in place of ``kernel/slots``), then the kernel: ``needs`` and ``adaptive``, written for
  the laws, ``rhs``, ``step``, ``events``, ... ``integrate``.

The integrator of one engine is two such modules. The kernel, in which the slots are declared, is
lowered once for all laws that need the same of the state
(:mod:`~saleg.compiler.shared_kernel`). Much shortened, it reads::

    import numba
    inline = numba.njit(
    cached = inline
    # --- laws/arguments.py
    class Gas(NamedTuple):
    # --- kernel/layout.py
    heat_release_burn_rate = DECLARED("heat_release_burn_rate", globals())
    springs_force = DECLARED("springs_force", globals())
    # --- kernel/rhs.py
    def rhs(P, E, C, t, y, dy, motored):
    # --- kernel/integrate.py
    def run_on(run):

The laws fill the slots, and :mod:`~saleg.compiler.linking` links them into that kernel::

    import numba
    inline = numba.njit(
    cached = numba.njit(
    # --- laws/arguments.py
    class Gas(NamedTuple):
    def both_heat_release_burn_rate__wiebe_rate(u, a, b):
    def both_heat_release_burn_rate(self, u):
        return both_heat_release_burn_rate__wiebe_rate(u, self.a, self.b)
    def heat_release_burn_rate(P, side, u):
        if side == 0:
            return both_heat_release_burn_rate(P.left.heat_release, u)
        return both_heat_release_burn_rate(P.right.heat_release, u)
    def engine_springs_force(self, motion):
        return -2.0 * self.stiffness * motion.x
    def springs_force(P, motion):
        return engine_springs_force(P.springs, motion)
    integrate = LINKED(globals())
    @cached
    def run_on(run):

Engines side by side, and any where numba has changed, have both in one module: the laws stand where
the slots are declared.

``P`` is the record of all numbers of all laws, so another number compiles nothing.

Where to look: :mod:`~saleg.compiler.compiled_engine` is the door the other floors come in by;
:mod:`~saleg.compiler.text` and :mod:`~saleg.compiler.slot_text` compose, of methods that
:mod:`~saleg.compiler.imported_text` finds,
:mod:`~saleg.compiler.slips` checks, :mod:`~saleg.compiler.source` makes ready and
:mod:`~saleg.compiler.strength_reduction` makes cheap, with the step that
:mod:`~saleg.compiler.unrolled` writes out for what the laws need
(:mod:`~saleg.compiler.needs`); :mod:`~saleg.compiler.diagnosis` names the
one that fails; :mod:`~saleg.compiler.module` executes the
text, kept in the :mod:`~saleg.compiler.cache`, its functions compiled as parts of their entry point
(:mod:`~saleg.compiler.inner_functions`); :mod:`~saleg.compiler.kernel` calls it, through
:mod:`~saleg.compiler.machine_code`; :mod:`~saleg.compiler.records` holds the numbers.
:mod:`~saleg.compiler.controllers` are composed by themselves, and so is the
:mod:`~saleg.compiler.search` for steady states, which needs no law and is compiled once for all.
:mod:`~saleg.compiler.plain` does without all of it. ``call_at`` and ``run_at`` are texts that
composed modules take in.
"""
