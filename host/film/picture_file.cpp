#include "host/film/picture_file.h"

#include <algorithm>
#include <string_view>

#include "host/base/input_error.h"
#include "host/base/srgb.h"
#include "host/scene/texture.h"

namespace raygate {

ChannelPicture read_picture(const std::filesystem::path& file, std::span<const std::string> names) {
  if (file.extension() != ".png" && file.extension() != ".PNG") return read_exr(file, names);
  const Texture texture = Texture::load(file);
  ChannelPicture picture;
  picture.width = texture.width();
  picture.height = texture.height();
  picture.window = {0, 0, picture.width, picture.height};
  constexpr std::string_view kColors[] = {"R", "G", "B"};
  for (const std::string& name : names) {
    const auto* const found = std::ranges::find(kColors, name);
    if (found == std::end(kColors)) {
      throw InputError(file.string() + ": has no channel " + name + ", a PNG has R, G and B");
    }
    const auto k = static_cast<std::size_t>(found - std::begin(kColors));
    picture.names.push_back(name);
    std::vector<double>& channel = picture.channels.emplace_back();
    channel.reserve(texture.texels().size());
    for (const Texture::Texel& codes : texture.texels()) {
      channel.push_back(srgb_to_linear(codes[k]));
    }
  }
  return picture;
}

}  // namespace raygate
