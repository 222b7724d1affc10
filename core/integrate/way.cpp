// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/way.hpp"

#include <algorithm>

namespace tinsmith::core {

const Way& Ways::of(std::size_t shape, std::size_t path) const {
    for (const Changed& changed : changed_)
        if (changed.shape == shape && changed.path == path) return kWays[changed.way];
    return kWays[common_];
}

bool Ways::change(std::size_t shape, std::size_t path) {
    if (++tries_ == kMaxTries) return false;
    auto found = std::find_if(changed_.begin(), changed_.end(), [&](const Changed& changed) {
        return changed.shape == shape && changed.path == path;
    });
    if (found == changed_.end()) found = changed_.insert(found, {shape, path, common_});
    if (++found->way < kWays.size()) return true;
    changed_.clear();
    return ++common_ < kWays.size();
}

}  // namespace tinsmith::core
