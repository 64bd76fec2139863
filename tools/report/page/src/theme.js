// Light, dark, or as the system likes it.
import { byId, choice } from "./dom.js";

const listeners = [];
const dark = matchMedia("(prefers-color-scheme: dark)");
let chosen = "auto";

export const onThemeChange = (listener) => listeners.push(listener);

export function resolvedColour(variable) {
    return getComputedStyle(document.documentElement).getPropertyValue(variable).trim();
}

function apply() {
    document.documentElement.dataset.theme = chosen !== "auto" ? chosen : dark.matches ? "dark" : "light";
    listeners.forEach((listener) => listener());
}

export function addThemeChoice() {
    const options = [
        { value: "auto", label: "Auto", title: "As the system is set" },
        { value: "light", label: "Light" },
        { value: "dark", label: "Dark" },
    ];
    const set = (value) => {
        chosen = value;
        apply();
    };
    byId("theme").append(choice("Theme", options, chosen, set).element);
    dark.addEventListener("change", apply);
    apply();
}
