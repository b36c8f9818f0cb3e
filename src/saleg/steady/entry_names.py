"""Names of the numbers a state at a dead centre is written in."""

from saleg.kernel import layout, orbit

#: Of the engine, by entry of the vector.
ENGINE_ENTRIES = {
    orbit.Z_POSITION: "position",
    orbit.Z_LN_SPEED: "ln_mean_piston_speed",
    orbit.Z_WEIGHT: "load_weight",
    orbit.Z_FRICTION: "friction_memory",
    orbit.Z_STROKE: "stroke",
    orbit.Z_FUEL_ENERGY: "fuel_energy",
    orbit.Z_SPEED_SQUARED: "speed_squared",
    orbit.Z_AMPERES: "current",
    orbit.Z_FRAME_X: "frame_position",
    orbit.Z_FRAME_V: "frame_velocity",
    orbit.Z_LN_MASS_MOVING: "ln_moving_mass",
}
#: Of a chamber, by entry after the first of its side.
CHAMBER_ENTRIES = {
    orbit.Z_LN_PRESSURE: "ln_pressure",
    orbit.Z_INTEGRAL: "ignition_integral",
    orbit.Z_LN_MOTORED: "ln_motored_pressure",
    orbit.Z_LN_MASS: "ln_mass",
    orbit.Z_FUEL: "fuel_fraction",
    orbit.Z_AIR: "air_fraction",
    orbit.Z_BURNT: "burnt_fraction",
    orbit.Z_RATIO: "equivalence_ratio",
    orbit.Z_BURN_PHASE: "burn_phase",
    orbit.Z_LN_DURATION: "ln_combustion_duration",
    orbit.Z_TO_BURN: "fraction_to_burn",
    orbit.Z_FRESH: "fresh_fraction",
    orbit.Z_WALL: "wall_temperature",
    orbit.Z_LN_CRANKCASE: "ln_crankcase_pressure",
    orbit.Z_CRANKCASE_MASS: "ln_crankcase_mass",
    orbit.Z_CRANKCASE_BURNT: "crankcase_burnt_fraction",
    orbit.Z_LN_LIT: "ln_mass_lit",
    orbit.Z_LN_CLOSING_PRESSURE: "ln_closing_pressure",
    orbit.Z_LN_CLOSING_TEMPERATURE: "ln_closing_temperature",
}
#: Name of every entry of the vector.
ENTRY_NAMES = {
    **ENGINE_ENTRIES,
    **{
        orbit.Z_CHAMBERS + layout.VECTOR_PER_SIDE * side + n: f"{name_of_side}.{name}"
        for side, name_of_side in enumerate(("left", "right"))
        for n, name in CHAMBER_ENTRIES.items()
    },
}
