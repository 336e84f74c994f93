// Names of classes as parts of file names.
#pragma once

#include <string>
#include <vector>

namespace seedframe {

/// One for each category: letters, digits, '_', '-' and '.' stay, other characters become '_', as
/// do
/// '.' and '-' at the beginning and '.' at the end. A name that was changed, is empty, or was taken
/// gets '~' and its number
/// (from 1) at the end, so that all differ, whatever the case of letters.
std::vector<std::string> class_folders(const std::vector<std::string>& categories);

}  // namespace seedframe
