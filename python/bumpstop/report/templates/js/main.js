// Puts the parts together.

function start() {
  document.documentElement.classList.add("js");
  const { themes, figures, motions, modes, runs } = readData();
  const chooser = runs ? new Runs(document.getElementById("run"), decode(runs)) : null;
  const plots = new Plots(figures, themes, (place) => chooser?.watch(place));
  const players = Object.entries(motions).map(
    ([name, scene]) => new Motion(document.getElementById(name), decode(scene)),
  );
  Object.entries(modes).forEach(
    ([name, scene]) => new Modes(document.getElementById(name), decode(scene)),
  );
  setUpTabs(() => players.forEach((player) => player.pause()));

  darkScreen.addEventListener("change", () => plots.redraw());
  const setPrinting = (now) => {
    printing = now;
    plots.redraw();
    players.forEach((player) => player.setPrinting(now));
  };
  window.addEventListener("beforeprint", () => setPrinting(true));
  window.addEventListener("afterprint", () => setPrinting(false));
  paper.addEventListener("change", (event) => setPrinting(event.matches));
}

start();
