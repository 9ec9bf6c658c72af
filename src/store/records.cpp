#include "store/records.hpp"

namespace rejoin::store {

const char* name_of(Stage stage) {
  switch (stage) {
    case Stage::Sweep:
      return "sweep";
    case Stage::Match:
      return "match";
    case Stage::Failed:
      break;
  }
  return "failed";
}

}  // namespace rejoin::store
