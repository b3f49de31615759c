// ---- Start ---------------------------------------------------------------------------------------

const SHOWS = { mission: showMission, run: showRun };

/** What is on the page, for the console and for tests. */
window.pleach = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const shown = SHOWS[data.kind](data), { player, selection } = shown;
  theme.start();
  const seek = at => {
    player.pause();
    player.seek(at);
  };
  document.querySelectorAll("button.instant").forEach(button =>
    button.addEventListener("click", () => seek(Number(button.dataset.at))));
  document.addEventListener("keydown", event => {
    if (event.key === "Escape") selection.set(null, null);
  });
  // The address may name an instant, index.html#at=358. Otherwise the run begins to play.
  const seekNamed = () => {
    const named = new URLSearchParams(location.hash.slice(1)).get("at");
    if (named !== null) seek(Number(named) || 0);
    return named !== null;
  };
  addEventListener("hashchange", seekNamed);
  if (!seekNamed() && !matchMedia("(prefers-reduced-motion: reduce)").matches) player.play();
  return shown;
})();
