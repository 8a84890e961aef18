// Elements, all text as text: nothing from a file is ever parsed as HTML.

export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== ""));
  return node;
}

/// A table. A cell is text, a node, or {text, ...attributes}; columns are {title, align}.
export function table(caption, columns, rows, attributes = {}) {
  const cell = (tag, content, align) => {
    const plain = typeof content !== "object" || content === null || content instanceof Node;
    const { text, ...more } = plain ? { text: content } : content;
    return el(tag, { class: align, ...more }, text ?? "");
  };
  const head = el("tr", {}, columns.map((c) => el("th", { scope: "col", class: c.align }, c.title)));
  const body = rows.map((row) =>
    el("tr", row.attributes ?? {}, (row.cells ?? row).map((c, i) => cell(i === 0 ? "th" : "td", c, columns[i].align))),
  );
  for (const row of body) row.firstChild?.setAttribute("scope", "row");
  return el(
    "div",
    { class: "scroll", tabindex: "0", role: "region", "aria-label": caption },
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

/// Calls `draw` when the element comes near the window, or before the page is printed: plots below cost nothing at
/// first.
export function whenSeen(element, draw) {
  let waiting = true;
  const once = () => {
    if (!waiting) return;
    waiting = false;
    observer.disconnect();
    draw();
  };
  const observer = new IntersectionObserver((entries) => entries.some((e) => e.isIntersecting) && once(), {
    rootMargin: "300px",
  });
  observer.observe(element);
  window.addEventListener("beforeprint", once);
}
