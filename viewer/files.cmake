# SPDX-License-Identifier: MIT
# What the page is made of. Scripts in the order in which they are joined: used before users.
set(VIEWER_SCRIPTS
  src/data.js
  src/voxels.js
  src/camera.js
  src/renderer.js
  src/scene.js
  src/overlay.js
  src/panels.js
  src/sight.js
  src/timeline.js
  src/compare.js
  src/controls.js
  src/main.js)
set(VIEWER_FILES src/index.html src/style.css ${VIEWER_SCRIPTS})
