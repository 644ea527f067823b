"use strict";
// In print nothing is folded away.
(() => {
  const folded = () => document.querySelectorAll("details");
  window.addEventListener("beforeprint", () => folded().forEach((one) => { one.dataset.was = one.open; one.open = true; }));
  window.addEventListener("afterprint", () => folded().forEach((one) => { one.open = one.dataset.was === "true"; }));
})();
