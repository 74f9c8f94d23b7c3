// Blank pictures: films in which nothing can be told apart.
#pragma once

#include <string>

#include "host/film/display.h"
#include "host/film/film.h"

namespace raygate {

/// Why nothing can be seen in a film, and what to try: no pixel has hit anything, all are black, or
/// all have one colour. Empty where something is seen, and of films that are only a crop or smaller
/// than 16 x 16 pixels, where that is nothing special.
[[nodiscard]] std::string why_blank(const Film& film, const DisplayOptions& display);

}  // namespace raygate
