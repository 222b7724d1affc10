// SPDX-License-Identifier: Apache-2.0
import {CanvasTexture, Color, DoubleSide, ShaderMaterial, SRGBColorSpace, Vector2} from 'three';

/** Low to high. */
export const RAMP = ['#4f7f6b', '#86a97f', '#c3c893', '#e2d3a0', '#cfa878', '#a97e62', '#efe9e2'];

export function rampTexture(): CanvasTexture {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [256, 1];
  const paint = canvas.getContext('2d')!;
  const gradient = paint.createLinearGradient(0, 0, 256, 0);
  RAMP.forEach((colour, i) => gradient.addColorStop(i / (RAMP.length - 1), colour));
  paint.fillStyle = gradient;
  paint.fillRect(0, 0, 256, 1);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}

const VERTEX = `
varying vec3 at;
uniform float exaggeration;
void main() {
  at = vec3(position.xy, position.z * exaggeration);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

// One facet, one shade: what is seen is the triangles, not a guess between them.
// `least_up` bounds how steep facets are taken to be: vertices that were drawn together to a pixel
// make slivers that stand upright, and would glitter.
const LIGHT = `
uniform float least_up;
vec3 facet() {
  vec3 n = normalize(cross(dFdx(at), dFdy(at)));
  n = n.z < 0.0 ? -n : n;
  return normalize(vec3(n.xy, max(n.z, least_up)));
}
float light(vec3 n) {
  float sun = max(dot(n, normalize(vec3(-0.55, 0.45, 0.7))), 0.0);
  return 0.42 + 0.16 * n.z + 0.62 * sun;
}`;

/** The ground: tinted by elevation, lit by facets, with contour lines where wanted. */
export function groundMaterial(ramp: CanvasTexture) {
  return new ShaderMaterial({
    side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 3, polygonOffsetUnits: 8,
    uniforms: {ramp: {value: ramp}, range: {value: new Vector2(0, 1)}, exaggeration: {value: 1}, contour: {value: 0}, grey: {value: 0}, least_up: {value: 0}},
    vertexShader: VERTEX,
    fragmentShader: `
varying vec3 at;
uniform sampler2D ramp;
uniform vec2 range;
uniform float exaggeration, contour, grey;
${LIGHT}
void main() {
  float z = at.z / exaggeration;
  vec3 tint = texture2D(ramp, vec2(clamp((z - range.x) / (range.y - range.x), 0.002, 0.998), 0.5)).rgb;
  tint = mix(tint, vec3(dot(tint, vec3(0.3, 0.6, 0.1))), grey);
  vec3 shade = tint * light(facet());
  if (contour > 0.0) {
    float level = z / contour;
    float near = abs(fract(level - 0.5) - 0.5) / max(fwidth(level), 1e-6);
    shade = mix(shade * 0.62, shade, clamp(near - 0.2, 0.0, 1.0));
  }
  gl_FragColor = vec4(shade, 1.0);
  #include <colorspace_fragment>
}`,
  });
}

/** How regions are told apart beside their colour; the legend draws the same. */
export const PATTERNS = ['rising', 'falling', 'upright', 'level', 'grid', 'dots'] as const;

export function regionMaterial(colour: string, pattern: number) {
  return new ShaderMaterial({
    side: DoubleSide, transparent: true, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4,
    uniforms: {colour: {value: new Color(colour)}, pattern: {value: pattern % PATTERNS.length}, strength: {value: 0.3}, pixel: {value: 1}, exaggeration: {value: 1}, least_up: {value: 0}},
    vertexShader: VERTEX,
    fragmentShader: `
varying vec3 at;
uniform vec3 colour;
uniform int pattern;
uniform float strength, pixel;
${LIGHT}
void main() {
  vec2 p = gl_FragCoord.xy / pixel;
  float along = pattern == 0 ? p.x - p.y : pattern == 1 ? p.x + p.y : pattern == 2 ? p.x * 1.41 : p.y * 1.41;
  bool on = mod(along, 12.0) < 2.4;
  if (pattern == 4) on = mod(p.x, 9.0) < 1.4 || mod(p.y, 9.0) < 1.4;
  if (pattern == 5) on = length(mod(p, 9.0) - 4.5) < 1.9;
  gl_FragColor = vec4(colour * (0.35 + 0.65 * light(facet())), on ? min(strength + 0.4, 0.95) : strength);
  #include <colorspace_fragment>
}`,
  });
}
