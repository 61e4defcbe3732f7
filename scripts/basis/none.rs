// SPDX-License-Identifier: MIT
// Cargo wants a target; there is nothing of ours to compile.
