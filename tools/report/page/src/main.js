import { addConvergence } from "./convergence.js";
import { addCost } from "./cost.js";
import { byId } from "./dom.js";
import { addMeasurements } from "./measurements.js";
import { addPictures } from "./pictures.js";
import { addRepeat } from "./repeat.js";
import { hasPicture, report } from "./report.js";
import { addStrips } from "./strips.js";
import { addSuite } from "./suite.js";
import { addThemeChoice } from "./theme.js";

const { shot, machine } = report;
document.title = `${shot.name} \u2013 Brisance report`;
byId("title").textContent = shot.name;
byId("subtitle").textContent = [
    `frame ${shot.frame} of ${shot.volume}`,
    `${shot.width} \u00d7 ${shot.height} pixels`,
    `${machine.processor}, ${machine.threads} ${machine.threads === 1 ? "thread" : "threads"}`,
    `Brisance ${report.brisance}`,
    report.date.replace("T", " ").replace("Z", " UTC"),
].join(" \u00b7 ");

addThemeChoice();
addSuite(byId("suite"), byId("suite-link"));
const plot = addConvergence(byId("convergence"), byId("reach"), byId("equal-time"));
const viewer = addPictures(byId("pictures"));
addStrips(byId("strips"), byId("strips-link"));
addMeasurements(byId("measurements"));
addCost(byId("cost"));
addRepeat(byId("repeat"));
plot.onPick((id) => hasPicture(id) && viewer.show({ left: id }));

// For scripts and the browser's console.
window.brisanceReport = { report, plot, viewer };
