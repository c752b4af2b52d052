#include "experiments/report/html.h"

namespace pliant {

const WebBundle& built_bundle() {
  static const WebBundle bundle;
  return bundle;
}

}  // namespace pliant
