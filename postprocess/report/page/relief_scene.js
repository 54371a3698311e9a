// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The view in 3-D: ground, flow and camera, drawn by three.js whenever something has changed.

const { BufferAttribute, BufferGeometry, CanvasTexture, Color, DoubleSide, LinearFilter, Mesh } = THREE;
const { MeshBasicMaterial, OrbitControls, PerspectiveCamera, Scene, Vector3, VertexColors, WebGLRenderer } = THREE;

const widestTexture = 2048;

/** Whether this browser draws with WebGL at all. */
export function canDraw() {
  try {
    const context = document.createElement("canvas").getContext("webgl");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return Boolean(context);
  } catch {
    return false;
  }
}

/** A picture no wider than graphics cards take. */
function fitted(picture) {
  const scale = widestTexture / Math.max(picture.width, picture.height);
  if (scale >= 1) return picture;
  const smaller = document.createElement("canvas");
  smaller.width = Math.round(picture.width * scale);
  smaller.height = Math.round(picture.height * scale);
  smaller.getContext("2d").drawImage(picture, 0, 0, smaller.width, smaller.height);
  return smaller;
}

/** Puts a picture on what a material is of. Only the first one changes the program that draws it. */
function dress(material, picture) {
  const image = fitted(picture);
  if (material.map) {
    material.map.image = image;
  } else {
    material.map = new CanvasTexture(image);
    Object.assign(material.map, { generateMipmaps: false, minFilter: LinearFilter });
    material.needsUpdate = true;
  }
  material.map.needsUpdate = true;
}

export class ReliefScene {
  constructor(canvas, relief) {
    this.relief = relief;
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new Scene();
    this.scene.background = new Color(0xe9edf0);
    this.makeGround();
    this.makeWalls();
    this.makeFlow();
    this.makeCamera(canvas);
  }

  makeGround() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.relief.positions(null), 3));
    geometry.setAttribute("uv", new BufferAttribute(this.relief.places(), 2));
    geometry.setIndex(new BufferAttribute(this.relief.triangles(null), 1));
    // A little behind, so that a thin flow on it is seen.
    this.ground = new MeshBasicMaterial({ polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 });
    this.scene.add(new Mesh(geometry, this.ground));
  }

  /** Walls below the rim of the ground, down to a level a little below the lowest. */
  makeWalls() {
    const { columns, rows } = this.relief.grid,
      top = this.relief.positions(null),
      foot = -0.06 * Math.max(this.relief.relief, 0.1 * this.relief.width);
    const rim = [];
    for (let i = 0; i < columns; ++i) rim.push(i);
    for (let j = 1; j < rows; ++j) rim.push(j * columns + columns - 1);
    for (let i = columns - 2; i >= 0; --i) rim.push((rows - 1) * columns + i);
    for (let j = rows - 2; j > 0; --j) rim.push(j * columns);
    const positions = [],
      triangles = [];
    rim.forEach((vertex, n) => {
      const next = (n + 1) % rim.length;
      const [x, y, z] = top.subarray(3 * vertex, 3 * vertex + 3);
      positions.push(x, y, z, x, y, foot);
      if (Number.isNaN(this.relief.bed[vertex] + this.relief.bed[rim[next]])) return;
      triangles.push(2 * n, 2 * n + 1, 2 * next, 2 * next, 2 * n + 1, 2 * next + 1);
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
    geometry.setIndex(triangles);
    this.scene.add(new Mesh(geometry, new MeshBasicMaterial({ color: 0x9aa1a8, side: DoubleSide })));
  }

  makeFlow() {
    // The outline is that of the classes on the picture, as on the map.
    this.skin = new MeshBasicMaterial({ vertexColors: VertexColors, side: DoubleSide, alphaTest: 0.9 });
    this.flow = new Mesh(new BufferGeometry(), this.skin);
    this.places = new BufferAttribute(this.relief.places(), 2);
    this.flow.frustumCulled = false; // its bounds change with every frame
    this.scene.add(this.flow);
  }

  makeCamera(canvas) {
    this.camera = new PerspectiveCamera(38, 1, 1, 10);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    Object.assign(this.controls, { enabled: false, enableKeys: false, screenSpacePanning: false });
    Object.assign(this.controls, { maxPolarAngle: 0.495 * Math.PI, minPolarAngle: 0.02 });
    this.controls.addEventListener("change", () => this.draw());
    this.exaggeration = 1;
    this.look(this.firstSide());
  }

  /** The side that the ground falls to, from which a slide is best seen: an angle from east, anticlockwise. */
  firstSide() {
    const { bed, grid } = this.relief;
    let east = 0,
      north = 0;
    for (let row = 0; row < grid.rows; ++row) {
      for (let column = 0; column < grid.columns; ++column) {
        const z = bed[row * grid.columns + column] - this.relief.low;
        if (Number.isNaN(z)) continue;
        east -= z * (column - 0.5 * grid.columns);
        north -= z * (row - 0.5 * grid.rows);
      }
    }
    return Math.atan2(north, east) + 0.6; // not straight up the slope
  }

  /** The camera where it sees all of it, from an angle (from east, anticlockwise) and 35 degrees above the horizon. */
  look(angle) {
    const height = this.exaggeration * this.relief.relief,
      middle = new Vector3(0, 0, 0.3 * height),
      size = 0.5 * Math.hypot(this.relief.width, this.relief.height, height),
      rise = (35 * Math.PI) / 180;
    const arm = new Vector3(
      Math.cos(rise) * Math.cos(angle),
      Math.cos(rise) * Math.sin(angle),
      Math.sin(rise),
    );
    Object.assign(this.camera, { near: 0.02 * size, far: 12 * size });
    Object.assign(this.controls, { minDistance: 0.1 * size, maxDistance: 8 * size });
    this.camera.updateProjectionMatrix();
    for (let far = 4 * size, pass = 0; pass < 6; ++pass) {
      this.camera.position.copy(middle).addScaledVector(arm, far);
      this.camera.lookAt(middle);
      this.camera.updateMatrixWorld();
      far *= this.reach() / 0.96;
    }
    this.controls.target.copy(middle);
    this.controls.update();
  }

  /** How far the ground reaches from the middle of the view, as a share of the way to its edge. */
  reach() {
    const { grid } = this.relief,
      places = this.groundPlaces ?? (this.groundPlaces = this.relief.positions(null)),
      step = Math.max(1, Math.floor(Math.max(grid.columns, grid.rows) / 40));
    let most = 0;
    for (let j = 0; j < grid.rows; j += Math.max(1, Math.min(step, grid.rows - 1 - j))) {
      for (let i = 0; i < grid.columns; i += Math.max(1, Math.min(step, grid.columns - 1 - i))) {
        const at = 3 * (j * grid.columns + i),
          place = new Vector3(places[at], places[at + 1], this.exaggeration * places[at + 2]).project(this.camera);
        most = Math.max(most, Math.abs(place.x), Math.abs(place.y));
      }
    }
    return most;
  }

  /** Angle of the camera about the middle, from east, anticlockwise [rad]. */
  get angle() {
    const { position } = this.camera,
      { target } = this.controls;
    return Math.atan2(position.y - target.y, position.x - target.x);
  }

  /** Turns the camera about the middle [rad], and brings it nearer by a factor. */
  turn(angle, nearer = 1) {
    const { position } = this.camera,
      arm = position.clone().sub(this.controls.target);
    arm.applyAxisAngle(new Vector3(0, 0, 1), angle).multiplyScalar(1 / nearer);
    position.copy(this.controls.target).add(arm);
    this.controls.update();
    this.draw();
  }

  exaggerate(times) {
    this.exaggeration = times;
    this.scene.scale.z = times;
    this.look(this.angle);
    this.draw();
  }

  drape(picture) {
    dress(this.ground, picture);
    this.draw();
  }

  /** The surface of the flow at a frame, with a picture of its classes on it. */
  showFrame(frame, picture) {
    const { positions, shades, triangles } = this.relief.flow(frame);
    dress(this.skin, picture);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    geometry.setAttribute("color", new BufferAttribute(shades, 3));
    geometry.setAttribute("uv", this.places);
    geometry.setIndex(new BufferAttribute(triangles, 1));
    this.flow.geometry.dispose();
    this.flow.geometry = geometry;
    this.draw();
  }

  resize(width, height) {
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
    this.drawn?.();
  }

  /** What is seen, as a picture. */
  picture() {
    this.renderer.render(this.scene, this.camera); // what it drew is kept until the browser shows it, no longer
    return this.renderer.domElement.toDataURL("image/png");
  }
}
