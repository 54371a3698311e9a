// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the report takes of three.js (Debian's package), bundled into a script of its own that defines THREE.
export {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Color,
  DoubleSide,
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  Scene,
  Vector3,
  VertexColors,
  WebGLRenderer,
} from "three/build/three.module.js";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
