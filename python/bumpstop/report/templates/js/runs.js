// The runs behind the points of a study: a click tells the run, and the command that opens it.

// The six digits that the page has of any number, without zeros at their end.
function sixDigits(value) {
  return Number.isFinite(value) ? String(Number(value.toPrecision(6))).replace("-", "−") : "–";
}

class Runs {
  constructor(place, { count, command, numbers, values, units }) {
    this.count = count;
    this.command = command;
    this.numbers = numbers;
    this.values = values;
    this.units = units;
    this.field = place.querySelector("[data-part=number]");
    this.told = place.querySelector("[data-part=told]");
    this.code = place.querySelector("[data-part=command]");
    this.copy = place.querySelector("[data-part=copy]");
    this.field.addEventListener("input", () => this.show(this.field.valueAsNumber));
    this.copy.addEventListener("click", () => this.copied());
    document.querySelectorAll("[data-run]").forEach((button) => {
      button.addEventListener("click", () => this.choose(Number(button.dataset.run)));
    });
    this.show(0);
  }

  watch(place) {
    place.on("plotly_click", ({ points }) => {
      const run = points[0].customdata;
      if (Number.isInteger(run) && run >= 0) this.choose(run);
    });
  }

  choose(run) {
    this.field.value = run;
    this.show(run);
  }

  show(run) {
    if (!Number.isInteger(run) || run < 0 || run >= this.count) return;
    this.code.textContent = `${this.command} ${run}`;
    this.copy.textContent = "Copy";
    const at = this.numbers.indexOf(run);
    const told = Object.entries(this.values).map(([name, column]) => {
      const value = column[at];
      const unit = this.units[name] ? ` ${this.units[name]}` : "";
      return `${name} = ${typeof value === "number" ? sixDigits(value) + unit : value}`;
    });
    this.told.textContent = at < 0 ? "" : told.join(", ");
  }

  async copied() {
    const range = document.createRange();
    range.selectNodeContents(this.code);
    getSelection().removeAllRanges();
    getSelection().addRange(range);
    // Pages from files may be refused the clipboard: what is selected can be copied by hand.
    await navigator.clipboard?.writeText(this.code.textContent).then(
      () => (this.copy.textContent = "Copied"),
      () => (this.copy.textContent = "Selected"),
    );
  }
}
