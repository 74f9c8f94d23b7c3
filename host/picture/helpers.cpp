#include "host/picture/helpers.h"

#include <algorithm>
#include <cassert>

#include "host/film/film_slice.h"
#include "host/picture/shared_tile.h"

namespace raygate {
namespace {

// What a rank that dies takes with it, and how seldom a helper has to be answered.
constexpr double kSeconds = 1.0;

}  // namespace

Helpers::Helpers(Ranks& ranks, const Tiles& tiles, int first_sample, Film& film)
    : ranks_(ranks),
      tiles_(tiles),
      first_sample_(first_sample),
      film_(film),
      room_(static_cast<std::size_t>(ranks.count()), 0) {}

bool Helpers::serve(Schedule& schedule) {
  bool came_back = false;
  while (const auto message = ranks_.receive()) {
    int& room = room_[static_cast<std::size_t>(message->from)];
    if (message->about == About::kRoom) {
      room = value_of<int>(message->bytes);
      most_room_ += room;
    } else if (message->about == About::kTraced) {
      const auto tile = value_of<SharedTile>(message->bytes);
      put_slice(film_, tile.rect, slice_in(message->bytes));
      schedule.end(tile.number);
      seconds_ += tile.seconds;
      passes_ += (tile.last - tile.end) / tile.step + 1;
      ++room;
      came_back = true;
    }
  }
  for (bool gave = true; gave;) {  // one each in turn
    gave = false;
    for (int rank = 1; rank < ranks_.count(); ++rank) {
      int& room = room_[static_cast<std::size_t>(rank)];
      if (room == 0) continue;
      const auto step = schedule.begin(rank, most_passes(schedule));
      if (!step) return came_back;
      give(rank, *step);
      --room;
      gave = true;
    }
  }
  return came_back;
}

/// Fewer and fewer towards the end, for all to end at once; and no more than take a second.
int Helpers::most_passes(const Schedule& schedule) const {
  const double share = static_cast<double>(schedule.left()) / (4.0 * most_room_);
  const double in_time = passes_ == 0 ? 1.0 : kSeconds * static_cast<double>(passes_) / seconds_;
  return static_cast<int>(std::clamp(std::min(share, in_time), 1.0, 1e6));
}

void Helpers::give(int rank, const Schedule::Step& step) {
  const auto samples = [&](int pass) { return first_sample_ + tiles_.samples_after(pass); };
  const SharedTile tile{.number = step.tile,
                        .rect = tiles_[step.tile],
                        .end = samples(step.pass),
                        .step = tiles_.samples_per_pass,
                        .last = samples(step.end_pass - 1),
                        .seconds = 0.0};
  ranks_.send(rank, About::kTile,
              message_of(tile, step.moves ? slice_of(film_, tile.rect) : std::string()));
}

bool Helpers::finish(RenderStats& stats) {
  for (int rank = 1; !told_ && rank < ranks_.count(); ++rank) ranks_.send(rank, About::kFinish, {});
  told_ = true;
  while (const auto message = ranks_.receive()) {
    if (message->about != About::kCounts) continue;  // one that has just come to help
    add(stats, value_of<RenderStats>(message->bytes));
    ++heard_;
  }
  return heard_ == ranks_.count() - 1;
}

}  // namespace raygate
