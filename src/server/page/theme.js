// The theme, dark or light: the system's theme, until the user chooses one.

const KEY = "halflight-theme";

function stored() {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null; // the browser keeps nothing
  }
}

// root: the viewer's element, which carries the theme. changed() is called after each change of the theme, until `signal` is
// aborted. Returns a function that switches between the dark and the light theme.
export function installTheme(root, changed, signal) {
  const apply = (theme) => { root.dataset.theme = theme; };
  const notebook = document.body.dataset.jpThemeLight; // JupyterLab has a theme of its own
  const system = matchMedia("(prefers-color-scheme: light)"), isLight = () => (notebook !== undefined ? notebook === "true" : system.matches);
  const follow = () => apply(stored() ?? (isLight() ? "light" : "dark"));
  follow();
  system.addEventListener("change", () => { follow(); changed(); }, { signal });
  return () => {
    const theme = root.dataset.theme === "dark" ? "light" : "dark";
    apply(theme);
    try {
      localStorage.setItem(KEY, theme);
    } catch {
      // the choice holds until the page is closed
    }
    changed();
  };
}
