// The unit of a scene's lengths: the unit that the volumes' files tell, or the unit that the user has given if
// the files tell none.

// The symbols of units by other names of these units. Figures use the same symbols (units.c of the
// library).
const SYMBOLS = {
  kilometre: "km", kilometer: "km", metre: "m", meter: "m", centimetre: "cm", centimeter: "cm", millimetre: "mm", millimeter: "mm", um: "µm",
  micrometre: "µm", micrometer: "µm", micron: "µm", "μm": "µm", nanometre: "nm", nanometer: "nm", A: "Å", angstrom: "Å", picometre: "pm", picometer: "pm",
};

// The symbol of a unit; "": there is no unit.
export const symbolOf = (unit) => (unit ? Object.hasOwn(SYMBOLS, unit) ? SYMBOLS[unit] : unit : "");

// Whether the file of a visible volume does not tell the unit of its lengths. A person can give the unit then.
export const isUnitless = ({ store: { scene }, start }) =>
  start.volumes.some((volume, v) => volume?.unit === null && scene.volumes[v] && scene.volumes[v].visible !== false);

// Returns the unit that the user has given, if the unit of a visible volume is unknown; else "".
export const givenUnit = ({ store, start }) => (isUnitless({ store, start }) ? String(store.page.unit ?? "") : "");

// Returns the symbol of the unit in which lengths are measured.
export const lengthUnit = ({ store, start }) => symbolOf(givenUnit({ store, start }) || start.volumes[0]?.unit);
