// ---- Start ---------------------------------------------------------------------------------------

const SHOWS = { mission: showMission, run: showRun };

/** What is on the page, for the console and for tests. */
window.pleach = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const shown = SHOWS[data.kind](data), { player, selection } = shown;
  theme.start();
  document.querySelectorAll("button.instant").forEach(button =>
    button.addEventListener("click", () => player.seek(Number(button.dataset.at))));
  document.addEventListener("keydown", event => {
    if (event.key === "Escape") selection.set(null, null);
  });
  // The address may name an instant: index.html#at=358
  const seekNamed = () => {
    const named = Number(new URLSearchParams(location.hash.slice(1)).get("at"));
    if (named > 0) player.seek(named);
  };
  addEventListener("hashchange", seekNamed);
  seekNamed();
  return shown;
})();
