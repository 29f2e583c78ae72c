// Puts the theme on before the first paint, so that a dark room is not flashed. What is kept here is written by
// src/lib/theme.ts; without it the system decides.
(function () {
  var kept = null;
  try {
    kept = localStorage.getItem("covr.theme");
  } catch {
    // A browser that keeps nothing.
  }
  var light = kept === "light" || (kept !== "dark" && matchMedia("(prefers-color-scheme: light)").matches);
  document.documentElement.dataset.theme = light ? "light" : "dark";
})();
