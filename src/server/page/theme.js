// Dark or light: the system's choice until the user has one.

const KEY = "halflight-theme";

function stored() {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null; // a browser that keeps nothing
  }
}

function apply(theme) {
  document.documentElement.dataset.theme = theme;
}

// Returns the function that changes from one to the other.
export function installTheme(changed) {
  const light = matchMedia("(prefers-color-scheme: light)");
  apply(stored() ?? (light.matches ? "light" : "dark"));
  return () => {
    const theme = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    apply(theme);
    try {
      localStorage.setItem(KEY, theme);
    } catch {
      // it holds until the page is closed
    }
    changed();
  };
}
