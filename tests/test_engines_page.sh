#!/usr/bin/env bash
# The shaders of docs/engines.md compile with the decode files of a pack: Vulkan's and Direct3D's as they are, those of
# engines behind stand-ins for the engines' names, Metal's as C++. Skipped without glslangValidator.
set -euo pipefail
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"
root=$PWD
lacquer=${LACQUER:-$PWD/build/release/lacquer}
if ! command -v glslangValidator >/dev/null; then
    echo "no glslangValidator"
    exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat >"$scratch/r.json" <<'END'
{"name": "small", "formats": ["ktx2", "c"], "budget": {"p99": 2e-2, "max": 5e-2}, "points": 100, "materials": [
 {"name": "car-paint", "layers": [{"dielectric": {"n": 1.5, "alpha": 0.1}, "medium": {"tau": 0.8}},
                                  {"conductor": {"n": 1.2, "kappa": 6.9, "alpha": {"min": 0.2, "max": 0.5}}}]}]}
END
"$lacquer" pack "$scratch/r.json" -o "$scratch/p" --cache "$scratch/c" >/dev/null
cd "$scratch/p"

# The block of the page with these words behind its fence.
block() {
    awk -v fence="\`\`\`$1" '$0 == fence { on = 1; found = 1; next } /^```$/ { on = 0 } on; END { exit !found }' \
        "$root/docs/engines.md" || { echo "FAILED: docs/engines.md has no block '$1'" >&2; exit 1; }
}
compile() { # OPTIONS... FILE
    glslangValidator "$@" -o /dev/null >log || { tail -20 log; echo "FAILED: glslangValidator $*" >&2; exit 1; }
}

block 'glsl vulkan' >vulkan.frag
compile -V -S frag vulkan.frag
block 'hlsl d3d12' >d3d12.hlsl
compile -D -V -S frag -e main d3d12.hlsl

{
    cat <<'END'
#define half4 float4
struct Varyings { float4 position : SV_Position; float3 normalWS : NORMAL; float3 positionWS : TEXCOORD0; };
struct Light { float3 direction; float3 color; float distanceAttenuation; };
float3 GetWorldSpaceNormalizeViewDir(float3 p) { return normalize(-p); }
Light GetMainLight() { Light l; l.direction = float3(0, 1, 0); l.color = float3(1, 1, 1); l.distanceAttenuation = 1; return l; }
float3 GlossyEnvironmentReflection(float3 r, float roughness, float occlusion) { return r * roughness * occlusion; }
float3 SampleSH(float3 n) { return n; }
END
    block 'hlsl unity' | grep -v '#include "Packages/'
} >unity.hlsl
compile -D -V -S frag -e Fragment unity.hlsl

{
    printf '#include "decode.hlsl"\nTexture2D Atlas;\nSamplerState AtlasSampler;\n'
    printf 'float3 custom(float3 N, float3 V, float3 L, float Alpha)\n{\n'
    block 'hlsl unreal'
    printf '}\nfloat4 main(float4 p : SV_Position) : SV_Target { return float4(custom(p.xyz, p.yzx, p.zxy, p.w), 1.0); }\n'
} >unreal.hlsl
compile -D -V -S frag -e main unreal.hlsl

{
    cat <<'END'
#version 300 es
precision highp float;
struct MaterialInputs { vec4 baseColor; };
struct ShadingData { vec3 f0; };
struct LightData { vec4 colorIntensity; vec3 l; float NdotL; vec3 worldPosition; float attenuation, visibility; };
uniform highp sampler2D materialParams_atlas;
uniform struct { float alpha; } materialParams;
in vec3 n, v;
out vec4 color;
vec3 getWorldNormalVector() { return normalize(n); }
vec3 getWorldViewVector() { return normalize(v); }
void prepareMaterial(inout MaterialInputs m) { m.baseColor.a = 1.0; }
END
    block 'glsl filament' | sed -e '1,/^fragment {$/d;$d' -e '/^#include "decode.glsl"$/{r decode.glsl' -e 'd}'
    cat <<'END'
void main() {
    MaterialInputs m = MaterialInputs(vec4(1.0));
    material(m);
    color = vec4(surfaceShading(m, ShadingData(v), LightData(vec4(1.0), n, 0.5, n, 1.0, 1.0)), 1.0);
}
END
} >filament.frag
glslangValidator -S frag filament.frag >log || { tail -20 log; echo "FAILED: filament" >&2; exit 1; }

# Metal: without attributes, without the sampler's arguments.
block 'metal metal' | sed 's/ *\[\[[a-z_(0)]*\]\]//g; s/^constexpr \(sampler atlas_sampler\)(.*)/static const \1{}/; s/^fragment //' >page.cc
c++ -std=c++14 -Wall -Wextra -Werror -I"$root/tests/consumers" -c page.cc -o page.o 2>log ||
    { head -20 log; echo "FAILED: metal" >&2; exit 1; }
