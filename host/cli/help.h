// What `./render --help` prints.
#pragma once

namespace raygate {

extern const char* const kRenderHelp;

}  // namespace raygate
