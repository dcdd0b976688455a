// The panels of the cuts of a volume, and of the cuts of the scene, which cut all volumes. Cuts are planes,
// boxes and spheres; each has its numbers and a switch. A cut that is switched off is not in the scene, but
// the panel remembers it.

import { corners, middle, placed, unplaced, worldBox } from "./boxes.js";
import { button, isActive, make, row, section, segments, select, shortNumber, tabs, toggle } from "./controls.js";
import { add, subtract } from "./vector.js";

const PARTS = { plane: [["point", "Point"], ["normal", "Direction"]], box: [["min", "Least"], ["max", "Greatest"]], sphere: [["center", "Centre"], ["radius", "Radius"]] };

// A new cut takes away the upper front part of the box.
function newCut(type, box) {
  const at = middle(box), sides = box.max.map((end, k) => end - box.min[k]);
  if (type === "plane") return { type, point: at, normal: [1, 0, 0] };
  if (type === "box") return { type, min: [at[0], box.min[1] - sides[1] / 10, at[2]], max: [0, 1, 2].map((k) => (k === 1 ? at[1] : box.max[k] + sides[k] / 10)) };
  return { type, center: [at[0], box.min[1], box.max[2]], radius: Math.max(...sides) / 3 };
}

// The cut, moved so that its middle, or a point of its plane, is at a point.
function movedTo(cut, point) {
  if (cut.type === "plane") return { ...cut, point };
  if (cut.type === "sphere") return { ...cut, center: point };
  const way = subtract(point, middle(cut));
  return { ...cut, min: add(cut.min, way), max: add(cut.max, way) };
}

// A row of one or three numbers.
function numbers({ label, noun, count, get, set }) {
  const fields = Array.from({ length: count }, (_, k) => {
    const name = count > 1 ? `${label} ${"xyz"[k]}` : label;
    const field = make("input", {
      type: "number", step: "any", "aria-label": `${name} of the ${noun}`,
      onchange: () => {
        const values = [get()].flat().map((value, n) => (n === k ? +field.value : value));
        if (field.value !== "" && Number.isFinite(+field.value)) set(count > 1 ? values : values[0]);
        update();
      },
    });
    return field;
  });
  function update() {
    [get()].flat().forEach((value, k) => { if (!isActive(fields[k])) fields[k].value = shortNumber(value); });
  }
  return { element: row(make("span", { class: "name" }, label), make("span", { class: "numbers" }, ...fields)), update };
}

// A panel of the cuts of one owner: owner() tells which it is (-1: none, the panel is hidden), cuts() are its cuts, take(name,
// cuts) changes them, box() is where they cut, transform() where that lies in the scene, others() are rows that follow. While it
// is open, the chosen cut has handles in the picture.
function panelOf({ title, noun, viewer: { overlay, report, slices }, owner, cuts: cutsNow, take: takeCuts, box, transform, others }) {
  const { element, body } = section(title, false);
  let list = [], chosen = 0, parts = []; // list: { cut, on } for each cut of the owner `of`
  let of = -1;

  const shown = (entries) => entries.filter((entry) => entry.on).map((entry) => entry.cut);
  // The list follows the scene when another volume is chosen or changes are undone.
  function follow() {
    const cuts = cutsNow();
    if (of === owner() && JSON.stringify(shown(list)) === JSON.stringify(cuts)) return false;
    of = owner();
    list = cuts.map((cut) => ({ cut, on: true }));
    chosen = Math.min(chosen, Math.max(list.length - 1, 0));
    return true;
  }
  function take(name, changed) {
    list = changed;
    const cuts = shown(list);
    takeCuts(`cuts ${name}`, ({ cuts: _, ...rest }) => (cuts.length > 0 ? { ...rest, cuts } : rest));
  }
  const entry = () => list[chosen];
  const changeCut = (name, part) => take(`${chosen} ${name}`, list.map((one, n) => (n === chosen ? { ...one, cut: { ...one.cut, ...part } } : one)));

  function setNumbers(key, value) {
    const cut = { ...entry().cut, [key]: value };
    if (cut.type === "plane" && Math.hypot(...cut.normal) === 0) report("A plane needs a direction.");
    else if (cut.type === "box" && cut.min.some((low, k) => low >= cut.max[k])) report("A box's greatest corner has to be beyond its least.");
    else if (cut.type === "sphere" && !(cut.radius > 0)) report("A sphere's radius has to be above 0.");
    else changeCut(key, { [key]: value });
  }

  const numbered = tabs({
    label: title, noun, count: () => list.length, chosen: () => chosen,
    choose: (n) => { chosen = n; build(); overlay.draw(); },
    add: () => { chosen = list.length; take("add", [...list, { cut: newCut("plane", box()), on: true }]); build(); },
    remove: () => {
      const left = list.filter((_, n) => n !== chosen);
      chosen = Math.max(Math.min(chosen, left.length - 1), 0);
      take("remove", left);
      build();
    },
  });

  function cutParts() {
    const { cut } = entry();
    const shape = segments({
      label: "Shape", choices: [["plane", "Plane"], ["box", "Box"], ["sphere", "Sphere"]], get: () => entry()?.cut.type,
      set: (type) => { take(`${chosen} type`, list.map((one, n) => (n === chosen ? { ...one, cut: newCut(type, box()) } : one))); build(); },
    });
    const places = PARTS[cut.type].map(([key, label]) => numbers({
      label, noun, count: key === "radius" ? 1 : 3, get: () => entry()?.cut[key] ?? cut[key], set: (value) => setNumbers(key, value),
    }));
    const toCrosshair = {
      element: row("", button("to the crosshair", () => {
        take(`${chosen} place`, list.map((one, n) => (n === chosen ? { ...one, cut: movedTo(one.cut, unplaced(slices.cursor, transform())) } : one)));
      }, { title: "Moves the cut to where the crosshair of the slices is" })),
      update() { this.element.hidden = slices.layout === "picture"; },
    };
    return [
      toggle({ label: "Cuts", get: () => entry()?.on === true, set: (on) => take(`${chosen} on`, list.map((one, n) => (n === chosen ? { ...one, on } : one))) }),
      shape, ...places, toCrosshair,
      segments({ label: "Keep", choices: [["outside", "Outside"], ["inside", "Inside"]], get: () => entry()?.cut.keep ?? "outside", set: (keep) => changeCut("keep", { keep }) }),
    ];
  }

  function build() {
    element.hidden = owner() < 0;
    if (element.hidden) return;
    follow();
    parts = [numbered, ...(list.length > 0 ? [...cutParts(), ...others()] : [])];
    body.replaceChildren(...parts.map((part) => part.element));
    parts.forEach((part) => part.update());
  }
  const update = () => {
    if (element.hidden !== owner() < 0 || (owner() >= 0 && follow())) build();
    else parts.forEach((part) => part.update());
  };
  const updateView = () => parts.forEach((part) => part.update()); // the layout says whether there is a crosshair
  const chosenCut = () => {
    if (owner() >= 0 && follow()) build();
    return element.open && owner() >= 0 && entry()?.on ? entry().cut : null;
  };
  overlay.addCut({
    noun, box, transform, cut: chosenCut,
    take: (cut) => take(`${chosen} place`, list.map((one, n) => (n === chosen ? { ...one, cut } : one))),
  });
  element.addEventListener("toggle", () => overlay.draw());
  build();
  return { element, update, updateView, rebuild: build };
}

// The switch for everything that is cut away: the cuts and clip boxes of all volumes, and the scene's cuts.
// It also says, below the picture, what the program has cut away by itself; one click brings this back.
export function cutSwitch(viewer) {
  const { store, start, find } = viewer;
  const cutsOf = ({ volumes, cuts }) => ({ volumes: volumes.map(({ cuts: own, clip }) => ({ cuts: own, clip })), cuts });
  const isCut = ({ volumes, cuts }) => cuts?.length > 0 || volumes.some((volume) => volume.cuts?.length > 0 || volume.clip);
  const withCuts = ({ cuts: _, ...scene }, { volumes, cuts }) => ({
    ...scene, ...(cuts ? { cuts } : {}),
    volumes: scene.volumes.map(({ cuts: __, clip: ___, ...volume }, n) => ({ ...volume, ...(volumes[n]?.cuts ? { cuts: volumes[n].cuts } : {}), ...(volumes[n]?.clip ? { clip: volumes[n].clip } : {}) })),
  });
  const chosen = start.volumes.reduce((count, about, n) => count + (about?.chosen_cuts ? start.scene.volumes[n].cuts.length : 0), 0);
  let away = null; // the cuts that the switch has taken off
  function set(on) {
    if (on && away !== null) store.change("all cuts", (scene) => withCuts(scene, away));
    else if (!on) {
      away = cutsOf(store.scene);
      store.change("all cuts", (scene) => withCuts(scene, { volumes: [] }));
    }
  }
  const all = toggle({ label: "All cuts", get: () => isCut(store.scene), set });
  const why = `${chosen} ${chosen === 1 ? "plane takes" : "planes take"} away what holds the object`;
  const told = make("p", { class: "facts", hidden: chosen === 0 }, `${why}: chosen by the program, as nobody said what to cut.`);
  const note = make("button", { type: "button", class: "note", hidden: chosen === 0, onclick: () => set(!isCut(store.scene)) });
  find("statistics").before(note);
  viewer.toggleCuts = () => { if (isCut(store.scene) || away !== null) set(!isCut(store.scene)); };
  const element = make("div", { class: "chooser" }, all.element, told);
  function update() {
    all.update();
    element.hidden = !isCut(store.scene) && away === null;
    note.textContent = isCut(store.scene) ? `show what holds it: ${chosen} ${chosen === 1 ? "plane cuts" : "planes cut"} it away` : "cut away again what holds it";
  }
  update();
  return { element, update };
}

export function cutPanel(viewer) {
  const { store, start, current } = viewer;
  const volume = () => store.scene.volumes[current.volume];
  const others = () => [
    select({
      label: "Cut faces", choices: [["face", "lit as flat cuts"], ["gradient", "lit by the data"], ["none", "not lit as faces"]],
      get: () => volume().cut_shading ?? "face", set: (value) => store.changeVolume(current.volume, "cut_shading", (v) => ({ ...v, cut_shading: value })),
    }),
    toggle({
      label: "Cut matter casts shadows", get: () => volume().cut_casts_shadow === true,
      set: (on) => store.changeVolume(current.volume, "cut_casts_shadow", (v) => ({ ...v, cut_casts_shadow: on })),
    }),
  ];
  return panelOf({
    title: "Cuts", noun: "cut", viewer, others, transform: () => volume().transform, owner: () => (volume() === undefined ? -1 : current.volume), cuts: () => volume().cuts ?? [],
    take: (name, change) => store.changeVolume(current.volume, name, change), box: () => worldBox(start.volumes[current.volume]),
  });
}

// The scene's own cuts, where it has several volumes or such cuts already.
export function sceneCutPanel(viewer) {
  const { store, start } = viewer;
  function box() {
    const places = start.volumes.flatMap((about, n) => corners(worldBox(about)).map((corner) => placed(corner, store.scene.volumes[n]?.transform)));
    return { min: [0, 1, 2].map((k) => Math.min(...places.map((at) => at[k]))), max: [0, 1, 2].map((k) => Math.max(...places.map((at) => at[k]))) };
  }
  const volumes = () => store.scene.volumes.length;
  return panelOf({
    title: "Cuts of the scene", noun: "cut of the scene", viewer, transform: () => ({}), others: () => [], box, cuts: () => store.scene.cuts ?? [],
    owner: () => (volumes() > 1 || (volumes() > 0 && store.scene.cuts?.length > 0) ? 0 : -1), take: (name, change) => store.change(`scene ${name}`, change),
  });
}
