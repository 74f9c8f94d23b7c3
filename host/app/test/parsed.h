// Command lines for tests, read in place.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "host/app/options.h"
#include "host/base/input_error.h"

namespace raygate {

inline Options parse(std::initializer_list<const char*> arguments) {
  return parse_options({arguments.begin(), arguments.end()});
}

inline std::string error_of(std::initializer_list<const char*> arguments) {
  try {
    (void)parse(arguments);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}

/// The error is one line and says `part`.
inline void expect_error(std::initializer_list<const char*> arguments, const std::string& part) {
  const std::string error = error_of(arguments);
  EXPECT_NE(error.find(part), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

}  // namespace raygate
