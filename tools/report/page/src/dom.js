// Elements from JavaScript. Text is always set as text: no name in a shot can become markup.

export function h(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(properties)) {
        if (value === undefined || value === null || value === false) continue;
        if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
        else if (name === "style") Object.entries(value).forEach(([key, v]) => element.style.setProperty(key, v));
        else if (name === "dataset") Object.assign(element.dataset, value);
        else element.setAttribute(name, value === true ? "" : value);
    }
    element.append(...children.flat().filter((child) => child !== null && child !== undefined));
    return element;
}

export const byId = (id) => document.getElementById(id);

// A row of buttons of which one is pressed. `options`: [{value, label, title}].
export function choice(label, options, value, onchange) {
    const buttons = options.map((option) =>
        h("button", { type: "button", title: option.title, onclick: () => set(option.value, true) }, option.label),
    );
    const set = (chosen, tell) => {
        value = chosen;
        buttons.forEach((button, i) => button.setAttribute("aria-pressed", String(options[i].value === chosen)));
        if (tell) onchange(chosen);
    };
    set(value, false);
    const element = h(
        "div",
        { class: "choice", role: "group", "aria-label": label },
        h("span", { class: "choice-label" }, label),
        h("div", { class: "buttons" }, buttons),
    );
    // One answer is no question.
    element.hidden = options.length < 2;
    return { element, set: (chosen) => set(chosen, false), value: () => value };
}

export function copyButton(text) {
    const button = h("button", { type: "button", class: "copy", title: "Copy to the clipboard" }, "Copy");
    button.addEventListener("click", async () => {
        try {
            await navigator.clipboard.writeText(text);
            button.textContent = "Copied";
        } catch {
            // A page from a file may be denied the clipboard: leave the text selected instead.
            const range = document.createRange();
            range.selectNodeContents(button.parentElement.querySelector("code"));
            getSelection().removeAllRanges();
            getSelection().addRange(range);
            button.textContent = "Selected";
        }
        setTimeout(() => (button.textContent = "Copy"), 1500);
    });
    return button;
}

// A command line, broken between its options rather than inside of one.
export function codeBlock(text) {
    const parts = text.split(/ (?=-)/).flatMap((part, i) => [i > 0 ? " " : "", h("span", {}, part)]);
    return h("div", { class: "code" }, h("pre", {}, h("code", {}, parts)), copyButton(text));
}

export function table(head, rows, properties = {}) {
    return h(
        "div",
        { class: "scroll" },
        h("table", properties, h("thead", {}, h("tr", {}, head)), h("tbody", {}, rows)),
    );
}
