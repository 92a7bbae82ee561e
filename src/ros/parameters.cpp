// SPDX-License-Identifier: BSD-3-Clause
#include <box_query/ros/parameters.h>
