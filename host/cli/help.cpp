#include "host/cli/help.h"

namespace raygate {

const char* const kRenderHelp =
    R"(Usage: ./render SCENE [options]     SCENE.obj, .glb, .gltf, .ply or .stl, or
                                    a SCENE.json about one: camera and lights
Renders a scene. A ray-tracing unit, simulated from its SystemVerilog, finds
the hits; --engine cpu finds the same without it, faster.
Writes SCENE.exr and SCENE.png into the current folder.

  ./render scenes/cornell.obj --engine cpu
  ./render scenes/teapot.obj -o pot.png --size 1280x720 --spp 16 --engine cpu
  ./render scenes/paper.obj --size 320x200 --lanes 4 --stats run.json

Engine
  --engine NAME              rtl: the simulated hardware (default); cpu: without
                             it, much faster; model: the unit's reference model;
                             check: rtl and cpu, stopping where they differ
  --unit NAME                pipeline: a test every clock (default); serial: the
                             paper's unit; core: a ray core, which walks the
                             tree by itself
  --memory latency=N,bytes=N,cache=N   of the ray core: clocks to a line (50),
                             bytes a clock (64), lines of a cache before it (0)
  --cores N                  ray cores behind one memory, per thread (1)
  --dump-image FILE          the memory that ray cores read, as it is
  --trace-pixel X,Y --trace FILE.vcd   no picture: the core's wave of its ray
  --arith NAME               structural: Booth trees, carry-select (default); or
                             behavioural: + and *, simulated faster
  --lanes 1|2|4|8            pipelined units side by side, per thread (1)
  --threads N                threads (one per processor)
  --instances auto|keep|write   a mesh in many places: in memory once or written
                             out; auto keeps what has over 4 million triangles
  --point-error X            compute a hit's point on the host if the unit's may
                             be off by X of the distance (2^-16; 0: always, inf)
  --no-skip NAMES            do work that cannot change the picture: culling,
                             records, light-behind, weightless, empty-tiles,
                             first-occluder, divisions or all

Picture
  -o, --output NAME          NAME.exr, NAME.png, or NAME (or a folder) for both
  --size WxH                 the frame in pixels (640x480)
  --crop X0,Y0,X1,Y1         only this part of it; X1 and Y1 are not included
  --camera EX,EY,EZ,TX,TY,TZ[,FOV]   eye, target, vertical field of view (35);
                             default: the scene file's, or the whole scene
  --view NAME|AZ,EL          the whole scene: front, back, left, right, top,
                             bottom, iso, or azimuth and elevation (33,24)
  --up AXIS                  upwards: x, -x, y ... (a guess: y or z)
  --fov DEGREES              vertical field of view of any camera (35)
  --projection NAME          perspective (default), orthographic, panorama
  --aperture R               radius of the lens: what is not in focus is blurred
                             where a pixel has several samples (0)
  --focus D                  distance of what is in focus (the target's)
  --ground on|off            a ground that shows shadows alone (on from above,
                             where there is no camera and no light)
  --exposure STOPS           exposure of the PNG in stops: +1 is twice as bright
  --tone clip|filmic         tone curve of the PNG (clip)
  --channels NAMES           more of the EXR: P,Albedo,objectId,tests,doubts; or
                             sums, from which --resume and ./merge go on
  --false-colour CHANNEL[:LOW:HIGH]=FILE.png   a channel in false colours
  --frames N                 a film of N pictures, NAME-0001 and on: along the
                             scene file's path, or once around the target

Light
  --integrator NAME          primary: camera rays alone, lit from the camera;
                             whitted: shadows, reflection, refraction (default);
                             path: full global illumination
  --spp N                    samples per pixel (1; 4 with --engine cpu)
  --error X                  samples only where the picture needs them, --spp at
                             most (1024): 16 are enough where the error is X
                             steps of an 8-bit display, n where it is X n / 16
  --samples A:B              of these only A to B-1, for ./merge to add the rest
  --filter NAME              reconstruction filter: box, tent, gauss or
                             blackman-harris (default)
  --depth, --max-depth N     reflections and refractions in a row (4; path: 64)
  --threshold X              whitted: ignore rays that weigh less (0.00390625)
  --ambient X                whitted: ambient light (from background or lights)
  --environment FILE         light from all around: EXR, HDR; latitude-longitude
  --environment-rotation DEG counter-clockwise, seen from above (0)
  --environment-strength X   times what the file has (1)
  --seed N                   seed of the random numbers (0)

Run
  --resume FILE.exr          go on from a picture with sums, or with a film
  --save-every SECONDS       save the unfinished pictures now and then
  --stats FILE.json          all statistics as JSON; - prints them
  --strict                   refuse faces without area, which are left out
  --smooth DEGREES           faces without normals are smooth where they meet at
                             so much or less (as the OBJ's s statements say)
  --no-scene-file            do not read the .json beside an OBJ
  -q, --quiet; -v, --verbose print no statistics and no progress; or all of them
  -h, --help; --version

Exit status: 0 done; 1 the engines differ, or an internal error; 2 the command
line, the scene or an output cannot be used; 130 interrupted (partial pictures).
)";

}  // namespace raygate
