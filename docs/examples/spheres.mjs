// Three spheres of a scene pack in three.js: the atlas through KTX2Loader, the materials through decode.glsl.
import * as THREE from 'three';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';

export const looks = {
    gold: 'lacquer_gold(atlas, mu, 0.25)',
    wood: 'lacquer_lacquered_wood(atlas, mu, 0.1, vec3(0.5, 0.28, 0.13))',
    paint: 'lacquer_car_paint(atlas, mu, 0.3)',
};

export async function spheres(renderer, pack) {
    const atlas = await new KTX2Loader().detectSupport(renderer).loadAsync(`${pack}/atlas.ktx2`);
    atlas.minFilter = atlas.magFilter = THREE.LinearFilter; // the loader starts with the nearest texel
    const decode = await (await fetch(`${pack}/decode.glsl`)).text();
    const material = look => new THREE.ShaderMaterial({
        uniforms: { atlas: { value: atlas }, L: { value: new THREE.Vector3(-0.4, 0.6, 0.7).normalize() } },
        vertexShader: `varying vec3 n, v; void main() { vec4 p = modelViewMatrix * vec4(position, 1.0);
            n = normalMatrix * normal; v = -p.xyz; gl_Position = projectionMatrix * p; }`,
        fragmentShader: `uniform sampler2D atlas; uniform vec3 L; varying vec3 n, v; ${decode}
            void main() { vec3 N = normalize(n), V = normalize(v);
                float mu = clamp(dot(N, V), 0.0, 1.0), light = dot(N, L), half_way = dot(N, normalize(V + L));
                LacquerLobes l = ${look};
                gl_FragColor = vec4(2.0 * lacquer_shade(atlas, l, mu, light, half_way) // a sun
                    + 0.3 * (l.top + l.inner + l.base), 1.0); // a sky, the same on all sides
                #include <colorspace_fragment>
            }` });
    const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(20, 2.4, 1, 20);
    Object.values(looks).forEach((look, i) => {
        const ball = new THREE.Mesh(new THREE.SphereGeometry(1, 128, 64), material(look));
        scene.add(ball.translateX(2.2 * (i - 1)));
    });
    camera.position.z = 9;
    return { scene, camera };
}
