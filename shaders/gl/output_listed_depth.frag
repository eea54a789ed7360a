// PLD_VIEW_OPACITY_DEPTH of pellucid.h, and where there are lists PLD_VIEW_MEAN_DEPTH: what they have told.
layout(binding = 13) uniform sampler2D layerDepths;  // of gl/exact_marks.frag

layout(location = 0) out vec4 picture;

void main() { picture = vec4(vec3(texelFetch(layerDepths, ivec2(gl_FragCoord.xy), 0).LISTED_DEPTH), 1.0f); }
