// Makes the page of what the data are of, and opens it at the frame that the address names or that is worth a look.
// SPDX-License-Identifier: MIT
'use strict';

const frameToOpen = {cull: cullPage, compare: comparePage, render: renderPage, vis: visPage, bake: bakePage}[data.page]();
if (player.frames) show(frameToOpen);
followHash();
drawCharts();
