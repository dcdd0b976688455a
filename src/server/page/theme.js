// Dark or light: the system's choice until the user has one.

const KEY = "halflight-theme";

function stored() {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null; // the browser keeps nothing
  }
}

// root: the viewer's element, which carries the theme. Returns the function that changes from one to the other.
export function installTheme(root, changed) {
  const apply = (theme) => { root.dataset.theme = theme; };
  const notebook = document.body.dataset.jpThemeLight; // JupyterLab has a theme of its own
  const light = notebook !== undefined ? notebook === "true" : matchMedia("(prefers-color-scheme: light)").matches;
  apply(stored() ?? (light ? "light" : "dark"));
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
