// Elements, all text as text: nothing from a file is ever parsed as HTML.

export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat(Infinity).filter((child) => ![null, undefined, false, ""].includes(child)));
  return node;
}

/// A table. A cell is text, a node, or {text, ...attributes}; columns are {title, align, span}, one without a title lying
/// under the one before. Columns that stay empty are left out.
export function table(caption, columns, rows, attributes = {}) {
  const plain = (content) => typeof content !== "object" || content === null || content instanceof Node;
  const cell = (tag, content, align) => {
    const { text, ...more } = plain(content) ? { text: content } : content;
    return el(tag, { class: align, ...more }, text ?? "");
  };
  const isEmpty = (content) => ["", null, undefined].includes(plain(content) ? content : content.text);
  const kept = columns.map((_, i) => i === 0 || rows.some((row) => !isEmpty((row.cells ?? row)[i])));
  const head = el("tr", {}, columns.map((c, i) =>
    kept[i] && c.title !== undefined && el("th", { scope: "col", class: c.align, colspan: c.span }, c.title)));
  const body = rows.map((row) =>
    el("tr", row.attributes ?? {}, (row.cells ?? row).map((c, i) => kept[i] && cell(i === 0 ? "th" : "td", c, columns[i].align))),
  );
  for (const row of body) row.firstChild?.setAttribute("scope", "row");
  return el(
    "div",
    { class: rows.length > 14 ? "scroll long" : "scroll", tabindex: "0", role: "region", "aria-label": caption },
    el("table", attributes, el("caption", {}, caption), el("thead", {}, head), el("tbody", {}, body)),
  );
}

/// A choice of a few as buttons of a radio group, of more as a list. `change` gets the value; returns the element, with
/// a function set(value) that chooses without asking back.
export function choice(label, name, options, value, change) {
  if (options.length > 5) {
    const select = el("select", { id: name, onchange: () => change(select.value) });
    for (const option of options) select.append(el("option", { value: option.value }, option.text));
    select.value = value;
    const node = el("div", { class: "choice" }, el("label", { for: name }, label), select);
    node.set = (to) => (select.value = to);
    return node;
  }
  const inputs = options.map((option) =>
    el("input", { type: "radio", name, id: `${name}-${option.value}`, value: option.value, onchange: () => change(option.value) }),
  );
  const node = el(
    "fieldset",
    { class: "choice" },
    el("legend", {}, label),
    el("div", { class: "buttons" }, inputs.map((input, i) => [input, el("label", { for: input.id }, options[i].text)])),
  );
  node.set = (to) => inputs.forEach((input) => (input.checked = input.value === to));
  node.set(value);
  return node;
}

export function section(id, title, ...children) {
  return el("section", { id, "aria-labelledby": `${id}-title` }, el("h2", { id: `${id}-title` }, title), ...children);
}

/// Calls `draw` when the element comes near the window, or before the page is printed: plots out of sight cost nothing.
/// Returns what to call where it is to be drawn again.
export function whenSeen(element, draw) {
  let near = false;
  let stale = true;
  const update = () => {
    if (!near || !stale) return;
    stale = false;
    draw();
  };
  const see = (isNear) => {
    near = isNear;
    update();
  };
  new IntersectionObserver((entries) => see(entries.at(-1).isIntersecting), { rootMargin: "250px" }).observe(element);
  window.addEventListener("beforeprint", () => see(true));
  return () => {
    stale = true;
    update();
  };
}
