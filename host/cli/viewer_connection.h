// The connection to a viewer that shows a picture while it is rendered: tev, or whatever speaks its
// protocol.
#pragma once

#include <string>

#include "host/film/film.h"

namespace raygate {

/// A viewer at HOST:PORT. It gets packets over TCP, each a length (uint32, itself included), a type
/// and a body, little-endian: github.com/Tom94/tev, src/Ipc.cpp.
class ViewerConnection {
 public:
  /// Throws InputError, one line, where no viewer listens.
  explicit ViewerConnection(const std::string& address);
  ViewerConnection(const ViewerConnection&) = delete;
  ViewerConnection& operator=(const ViewerConnection&) = delete;
  ~ViewerConnection();

  /// Shows all channels of a film, as they are in an EXR, under this name. A viewer that is gone,
  /// or takes nothing for ten seconds, is warned about once, and gets no more.
  void show(const Film& film, const std::string& name);

 private:
  void send(std::string packet);

  std::string address_;
  int socket_ = -1;      // -1: gone
  std::string created_;  // the picture that the viewer has
};

}  // namespace raygate
