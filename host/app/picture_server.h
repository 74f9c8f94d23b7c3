// Picture server: a page in the browser that shows one scene while its camera, engine and options
// change, as --serve asks for.
#pragma once

#include <memory>

#include "host/app/options.h"
#include "host/intersect/core/memory_image.h"
#include "host/light/prepared_scene.h"
#include "host/scene/scene.h"

namespace raygate {

/// What all pictures of the page share. The references must outlive the server.
struct ServedScene {
  const Scene& unframed;  ///< as its file has it, without a ground: cameras frame it
  const PreparedScene& prepared;
  bool has_ground;  ///< in `prepared`
};

/// Serves the page until a signal comes, at 127.0.0.1 and to no other host. What it answers:
///
///   GET /                    the page
///   GET /picture?OPTIONS     a PNG, the bytes that ./render writes with these options; the header
///                            X-Command has that command, X-Statistics what it took, as JSON
///   GET /camera?OPTIONS      eye, target, up, field of view and size, as JSON; `view` where the
///                            options frame the whole scene
///   GET /pixel?x=X&y=Y&OPTIONS  the camera ray through a pixel's middle: what it hits, in decimal
///                            and as binary32 words, found by the options' engine and in place
///
/// OPTIONS are those of ./render that change neither the scene nor files, without dashes:
/// engine=cpu&size=80x60. They take the place of what `options` has. `slot=NAME&turn=N` ends the
/// pictures of that slot with a smaller N (status 204, no picture); so does the end of a picture's
/// connection. Pictures have at most 2^24 pixels of 2^16 samples. A bad option is one line of
/// text, status 400. Throws InputError where the port cannot be had.
void serve_pictures(const Options& options, const ServedScene& scene);

}  // namespace raygate
