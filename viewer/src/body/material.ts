import * as three from "three";
import { fieldColours } from "../colours";

/** Material that colours triangles by a field, shades them in space, and draws the edges of cells. */
export function bodyMaterial(shaded: boolean): three.ShaderMaterial {
  const colours = new three.DataTexture(fieldColours, 256, 1, three.RGBAFormat);
  colours.minFilter = colours.magFilter = three.LinearFilter;
  colours.needsUpdate = true;
  return new three.ShaderMaterial({
    glslVersion: three.GLSL3,
    side: three.DoubleSide,
    // Outlines and edges are drawn in front of their faces.
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    uniforms: {
      colours: { value: colours },
      low: { value: 0 },
      high: { value: 1 },
      logarithmic: { value: false },
      cuts: { value: false },
      cut: { value: new three.Vector4() }, // the part that is initially above w along xyz is cut off
      kind: { value: 0 }, // 0 plain, 1 numbers, 2 statuses, 3 numbers of bodies
      plain: { value: new three.Color() },
      line: { value: new three.Color() },
      lines: { value: 0 }, // darkness of the edges of cells
      statuses: { value: Array.from({ length: 5 }, () => new three.Color()) },
      shaded: { value: shaded },
    },
    vertexShader: `
      in vec3 values;   // values at the three corners
      in float edges;   // bit k: the side from corner k is an edge of a cell
      in vec3 origin;   // initial position of the corner
      uniform vec4 cut;
      out float above;
      out vec3 place;   // barycentric
      out vec3 corners;
      out vec3 view;
      flat out vec3 hidden;
      void main() {
        int corner = gl_VertexID % 3;
        place = vec3(corner == 0, corner == 1, corner == 2);
        corners = values;
        above = dot(cut.xyz, origin) - cut.w;
        int bits = int(edges + 0.5);
        // The side from corner k + 1 is opposite to corner k.
        hidden = vec3((bits & 2) == 0, (bits & 4) == 0, (bits & 1) == 0);
        vec4 at = modelViewMatrix * vec4(position, 1.0);
        view = at.xyz;
        gl_Position = projectionMatrix * at;
      }`,
    fragmentShader: `
      precision highp float;
      uniform sampler2D colours;
      uniform float low, high, lines;
      uniform int kind;
      uniform vec3 plain, line, statuses[5];
      uniform bool shaded, cuts, logarithmic;
      in float above;
      in vec3 place, corners, view;
      flat in vec3 hidden;
      out vec4 colour;
      void main() {
        if (cuts && above > 0.0) discard;
        vec3 c = plain;
        if (kind == 1) {
          float value = dot(place, corners);
          float part = logarithmic ? log(max(value, low) / low) / log(high / low) : (value - low) / (high - low);
          if (value == value) c = texture(colours, vec2(part * (255.0 / 256.0) + 0.5 / 256.0, 0.5)).rgb;
        } else if (kind == 2) {
          float value = place.x > place.y ? (place.x > place.z ? corners.x : corners.z)
                                          : (place.y > place.z ? corners.y : corners.z);
          if (value == value) c = statuses[int(clamp(value + 1.5, 0.0, 4.0))];
        } else if (kind == 3) {
          c = mix(plain, line, 0.22 * mod(corners.x, 3.0)); // three shades distinguish neighbours
        }
        if (shaded) {
          vec3 normal = normalize(cross(dFdx(view), dFdy(view)));
          c *= 0.5 + 0.5 * abs(dot(normal, normalize(vec3(0.25, 0.35, 1.0))));
        }
        if (lines > 0.0) {
          vec3 distance = place / max(fwidth(place), 1e-9) + 100.0 * hidden;
          float nearest = min(distance.x, min(distance.y, distance.z));
          c = mix(c, line, lines * (1.0 - smoothstep(0.4, 1.2, nearest)));
        }
        colour = vec4(c, 1.0);
      }`,
  });
}
