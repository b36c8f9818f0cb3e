"""Names of the numbers a state at a dead centre is written in."""

from saleg.kernel import layout, vector

#: Of the engine, by entry of the vector.
ENGINE_ENTRIES = {
    vector.Z_POSITION: "position",
    vector.Z_LN_SPEED: "ln_mean_piston_speed",
    vector.Z_WEIGHT: "load_weight",
    vector.Z_FRICTION: "friction_memory",
    vector.Z_STROKE: "stroke",
    vector.Z_FUEL_ENERGY: "fuel_energy",
    vector.Z_SPEED_SQUARED: "speed_squared",
    vector.Z_AMPERES: "current",
    vector.Z_FRAME_X: "frame_position",
    vector.Z_FRAME_V: "frame_velocity",
    vector.Z_LN_MASS_MOVING: "ln_moving_mass",
}
#: Of a chamber, by entry after the first of its side.
CHAMBER_ENTRIES = {
    vector.Z_LN_PRESSURE: "ln_pressure",
    vector.Z_INTEGRAL: "ignition_integral",
    vector.Z_LN_MOTORED: "ln_motored_pressure",
    vector.Z_LN_MASS: "ln_mass",
    vector.Z_FUEL: "fuel_fraction",
    vector.Z_AIR: "air_fraction",
    vector.Z_BURNT: "burnt_fraction",
    vector.Z_RATIO: "equivalence_ratio",
    vector.Z_BURN_PHASE: "burn_phase",
    vector.Z_LN_DURATION: "ln_combustion_duration",
    vector.Z_TO_BURN: "fraction_to_burn",
    vector.Z_FRESH: "fresh_fraction",
    vector.Z_WALL: "wall_temperature",
    vector.Z_LN_CRANKCASE: "ln_crankcase_pressure",
    vector.Z_CRANKCASE_MASS: "ln_crankcase_mass",
    vector.Z_CRANKCASE_BURNT: "crankcase_burnt_fraction",
    vector.Z_LN_LIT: "ln_mass_lit",
    vector.Z_LN_CLOSING_PRESSURE: "ln_closing_pressure",
    vector.Z_LN_CLOSING_TEMPERATURE: "ln_closing_temperature",
}
#: Name of every entry of the vector.
ENTRY_NAMES = {
    **ENGINE_ENTRIES,
    **{
        vector.Z_CHAMBERS + layout.VECTOR_PER_SIDE * side + n: f"{name_of_side}.{name}"
        for side, name_of_side in enumerate(("left", "right"))
        for n, name in CHAMBER_ENTRIES.items()
    },
}
