// Tabs after the WAI-ARIA pattern: arrow keys, Home and End move between them.

function setUpTabs(onShow) {
  const list = document.querySelector("[role=tablist]");
  if (!list) return;
  list.hidden = false;
  const tabs = [...list.querySelectorAll("[role=tab]")];
  const panelOf = (tab) => document.getElementById(tab.getAttribute("aria-controls"));

  const show = (chosen) => {
    for (const tab of tabs) {
      const selected = tab === chosen;
      tab.setAttribute("aria-selected", String(selected));
      tab.tabIndex = selected ? 0 : -1;
      panelOf(tab).classList.toggle("is-hidden", !selected);
    }
    onShow();
  };

  const stepFor = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };
  list.addEventListener("keydown", (event) => {
    const at = tabs.indexOf(document.activeElement);
    let next = null;
    if (event.key in stepFor) next = (at + stepFor[event.key] + tabs.length) % tabs.length;
    else if (event.key === "Home") next = 0;
    else if (event.key === "End") next = tabs.length - 1;
    if (at < 0 || next === null) return;
    event.preventDefault();
    tabs[next].focus();
    show(tabs[next]);
  });
  tabs.forEach((tab) => tab.addEventListener("click", () => show(tab)));
  show(tabs[0]);
}
