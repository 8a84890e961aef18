#include "batch_loop.h"

namespace goniofit::stability {

std::vector<BatchLoop> student_t_loops() { return batch_loop::dd_loops<DistributionTier::student_t>(); }

}  // namespace goniofit::stability
