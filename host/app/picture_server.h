// Picture server of --serve: a page in the browser that shows a scene, with any options.
#pragma once

#include "host/app/options.h"
#include "host/light/prepared_scene.h"
#include "host/scene/scene.h"

namespace raygate {

/// The scene of the page. The references must outlive the server.
struct ServedScene {
  const Scene& unframed;  ///< without the ground, for framing
  const PreparedScene& prepared;
  bool has_ground;  ///< whether `prepared` has the ground
};

/// Serves the page at 127.0.0.1 until a signal arrives. Requests:
///
///   GET /                    the page
///   GET /picture?OPTIONS     the PNG of ./render with these options; the header X-Command has the
///                            command line, X-Statistics the render's statistics as JSON
///   GET /camera?OPTIONS      eye, target, up, field of view and size as JSON; also `view` if the
///                            options frame the whole scene
///
/// OPTIONS are options of ./render that appear at kInPage, without dashes: engine=cpu&size=80x60.
/// They override `options`. A closed connection cancels its picture. The reply to a bad option is
/// one line of text with status 400. Throws InputError if the port is not available.
void serve_pictures(const Options& options, const ServedScene& scene);

}  // namespace raygate
