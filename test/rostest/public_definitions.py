# SPDX-License-Identifier: BSD-3-Clause
"""Message types of other packages, built at run time from their public definitions, without these packages.

genpy computes the checksums from the definitions, as roscpp and rospy do where the packages are installed.
"""

from genpy.dynamic import generate_dynamic

# Fields as the packages define them, comments left out. A type is named with its package throughout.
DEFINITIONS = {
    'std_msgs/Header': 'uint32 seq\ntime stamp\nstring frame_id',
    'std_msgs/ColorRGBA': 'float32 r\nfloat32 g\nfloat32 b\nfloat32 a',
    'geometry_msgs/Point': 'float64 x\nfloat64 y\nfloat64 z',
    'geometry_msgs/Point32': 'float32 x\nfloat32 y\nfloat32 z',
    'geometry_msgs/Vector3': 'float64 x\nfloat64 y\nfloat64 z',
    'geometry_msgs/Quaternion': 'float64 x\nfloat64 y\nfloat64 z\nfloat64 w',
    'geometry_msgs/Pose': 'geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation',
    'geometry_msgs/PoseStamped': 'std_msgs/Header header\ngeometry_msgs/Pose pose',
    'geometry_msgs/PoseWithCovariance': 'geometry_msgs/Pose pose\nfloat64[36] covariance',
    'geometry_msgs/Twist': 'geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular',
    'geometry_msgs/TwistStamped': 'std_msgs/Header header\ngeometry_msgs/Twist twist',
    'geometry_msgs/Transform': 'geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation',
    'geometry_msgs/TransformStamped': """
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform""",
    'geometry_msgs/Wrench': 'geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque',
    'geometry_msgs/Accel': 'geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular',
    'geometry_msgs/Polygon': 'geometry_msgs/Point32[] points',
    'geometry_msgs/PolygonStamped': 'std_msgs/Header header\ngeometry_msgs/Polygon polygon',
    'sensor_msgs/PointField': """
uint8 INT8=1
uint8 UINT8=2
uint8 INT16=3
uint8 UINT16=4
uint8 INT32=5
uint8 UINT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
string name
uint32 offset
uint8 datatype
uint32 count""",
    'sensor_msgs/PointCloud2': """
std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense""",
    'sensor_msgs/Image': """
std_msgs/Header header
uint32 height
uint32 width
string encoding
uint8 is_bigendian
uint32 step
uint8[] data""",
    'shape_msgs/SolidPrimitive': """
uint8 BOX=1
uint8 SPHERE=2
uint8 CYLINDER=3
uint8 CONE=4
uint8 type
float64[] dimensions
uint8 BOX_X=0
uint8 BOX_Y=1
uint8 BOX_Z=2
uint8 SPHERE_RADIUS=0
uint8 CYLINDER_HEIGHT=0
uint8 CYLINDER_RADIUS=1
uint8 CONE_HEIGHT=0
uint8 CONE_RADIUS=1""",
    'shape_msgs/MeshTriangle': 'uint32[3] vertex_indices',
    'shape_msgs/Mesh': 'shape_msgs/MeshTriangle[] triangles\ngeometry_msgs/Point[] vertices',
    'shape_msgs/Plane': 'float64[4] coef',
    'object_recognition_msgs/ObjectType': 'string key\nstring db',
    'jsk_recognition_msgs/BoundingBox': """
std_msgs/Header header
geometry_msgs/Pose pose
geometry_msgs/Vector3 dimensions
float32 value
uint32 label""",
    'jsk_recognition_msgs/BoundingBoxArray': 'std_msgs/Header header\njsk_recognition_msgs/BoundingBox[] boxes',
    'vision_msgs/BoundingBox3D': 'geometry_msgs/Pose center\ngeometry_msgs/Vector3 size',
    'vision_msgs/BoundingBox3DArray': 'std_msgs/Header header\nvision_msgs/BoundingBox3D[] boxes',
    'vision_msgs/ObjectHypothesisWithPose': 'int64 id\nfloat64 score\ngeometry_msgs/PoseWithCovariance pose',
    'vision_msgs/Detection3D': """
std_msgs/Header header
vision_msgs/ObjectHypothesisWithPose[] results
vision_msgs/BoundingBox3D bbox
sensor_msgs/PointCloud2 source_cloud""",
    'vision_msgs/Detection3DArray': 'std_msgs/Header header\nvision_msgs/Detection3D[] detections',
    'derived_object_msgs/Object': """
std_msgs/Header header
uint32 id
uint8 detection_level
uint8 OBJECT_DETECTED=0
uint8 OBJECT_TRACKED=1
bool object_classified
geometry_msgs/Pose pose
geometry_msgs/Twist twist
geometry_msgs/Accel accel
geometry_msgs/Polygon polygon
shape_msgs/SolidPrimitive shape
uint8 classification
uint8 CLASSIFICATION_UNKNOWN=0
uint8 CLASSIFICATION_UNKNOWN_SMALL=1
uint8 CLASSIFICATION_UNKNOWN_MEDIUM=2
uint8 CLASSIFICATION_UNKNOWN_BIG=3
uint8 CLASSIFICATION_PEDESTRIAN=4
uint8 CLASSIFICATION_BIKE=5
uint8 CLASSIFICATION_CAR=6
uint8 CLASSIFICATION_TRUCK=7
uint8 CLASSIFICATION_MOTORCYCLE=8
uint8 CLASSIFICATION_OTHER_VEHICLE=9
uint8 CLASSIFICATION_BARRIER=10
uint8 CLASSIFICATION_SIGN=11
uint8 classification_certainty
uint32 classification_age""",
    'derived_object_msgs/ObjectArray': 'std_msgs/Header header\nderived_object_msgs/Object[] objects',
    'autoware_msgs/DTLane': """
float64 dist
float64 dir
float64 apara
float64 r
float64 slope
float64 cant
float64 lw
float64 rw""",
    'autoware_msgs/WaypointState': """
int32 aid
uint8 NULLSTATE=0
uint8 lanechange_state
uint8 steering_state
uint8 STR_LEFT=1
uint8 STR_RIGHT=2
uint8 STR_STRAIGHT=3
uint8 STR_BACK=4
uint8 accel_state
uint8 stop_state
uint8 TYPE_STOPLINE=1
uint8 TYPE_STOP=2
uint8 event_state
uint8 TYPE_EVENT_NULL=0
uint8 TYPE_EVENT_GOAL=1
uint8 TYPE_EVENT_MIDDLE_GOAL=2
uint8 TYPE_EVENT_POSITION_STOP=3
uint8 TYPE_EVENT_BUS_STOP=4
uint8 TYPE_EVENT_PARKING=5""",
    'autoware_msgs/Waypoint': """
int32 gid
int32 lid
geometry_msgs/PoseStamped pose
geometry_msgs/TwistStamped twist
autoware_msgs/DTLane dtlane
int32 change_flag
autoware_msgs/WaypointState wpstate
uint32 lane_id
uint32 left_lane_id
uint32 right_lane_id
uint32 stop_line_id
float32 cost
float32 time_cost
uint32 direction""",
    'autoware_msgs/Lane': """
std_msgs/Header header
int32 increment
int32 lane_id
autoware_msgs/Waypoint[] waypoints
uint32 lane_index
float32 cost
float32 closest_object_distance
float32 closest_object_velocity
bool is_blocked""",
    'autoware_msgs/LaneArray': 'int32 id\nautoware_msgs/Lane[] lanes',
    'autoware_msgs/DetectedObject': """
std_msgs/Header header
uint32 id
string label
float32 score
std_msgs/ColorRGBA color
bool valid
string space_frame
geometry_msgs/Pose pose
geometry_msgs/Vector3 dimensions
geometry_msgs/Vector3 variance
geometry_msgs/Twist velocity
geometry_msgs/Twist acceleration
sensor_msgs/PointCloud2 pointcloud
geometry_msgs/PolygonStamped convex_hull
autoware_msgs/LaneArray candidate_trajectories
bool pose_reliable
bool velocity_reliable
bool acceleration_reliable
string image_frame
int32 x
int32 y
int32 width
int32 height
float32 angle
sensor_msgs/Image roi_image
uint8 indicator_state
uint8 behavior_state
string[] user_defined_info""",
    'autoware_msgs/DetectedObjectArray': 'std_msgs/Header header\nautoware_msgs/DetectedObject[] objects',
    'moveit_msgs/CollisionObject': """
std_msgs/Header header
geometry_msgs/Pose pose
string id
object_recognition_msgs/ObjectType type
shape_msgs/SolidPrimitive[] primitives
geometry_msgs/Pose[] primitive_poses
shape_msgs/Mesh[] meshes
geometry_msgs/Pose[] mesh_poses
shape_msgs/Plane[] planes
geometry_msgs/Pose[] plane_poses
string[] subframe_names
geometry_msgs/Pose[] subframe_poses
byte ADD=0
byte REMOVE=1
byte APPEND=2
byte MOVE=3
byte operation""",
    'sensor_msgs/JointState': """
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort""",
    'sensor_msgs/MultiDOFJointState': """
std_msgs/Header header
string[] joint_names
geometry_msgs/Transform[] transforms
geometry_msgs/Twist[] twist
geometry_msgs/Wrench[] wrench""",
    'trajectory_msgs/JointTrajectoryPoint': """
float64[] positions
float64[] velocities
float64[] accelerations
float64[] effort
duration time_from_start""",
    'trajectory_msgs/JointTrajectory': """
std_msgs/Header header
string[] joint_names
trajectory_msgs/JointTrajectoryPoint[] points""",
    'octomap_msgs/Octomap': """
std_msgs/Header header
bool binary
string id
float64 resolution
int8[] data""",
    'octomap_msgs/OctomapWithPose': """
std_msgs/Header header
geometry_msgs/Pose origin
octomap_msgs/Octomap octomap""",
    'moveit_msgs/AttachedCollisionObject': """
string link_name
moveit_msgs/CollisionObject object
string[] touch_links
trajectory_msgs/JointTrajectory detach_posture
float64 weight""",
    'moveit_msgs/RobotState': """
sensor_msgs/JointState joint_state
sensor_msgs/MultiDOFJointState multi_dof_joint_state
moveit_msgs/AttachedCollisionObject[] attached_collision_objects
bool is_diff""",
    'moveit_msgs/AllowedCollisionEntry': 'bool[] enabled',
    'moveit_msgs/AllowedCollisionMatrix': """
string[] entry_names
moveit_msgs/AllowedCollisionEntry[] entry_values
string[] default_entry_names
bool[] default_entry_values""",
    'moveit_msgs/LinkPadding': 'string link_name\nfloat64 padding',
    'moveit_msgs/LinkScale': 'string link_name\nfloat64 scale',
    'moveit_msgs/ObjectColor': 'string id\nstd_msgs/ColorRGBA color',
    'moveit_msgs/PlanningSceneWorld': """
moveit_msgs/CollisionObject[] collision_objects
octomap_msgs/OctomapWithPose octomap""",
    'moveit_msgs/PlanningScene': """
string name
moveit_msgs/RobotState robot_state
string robot_model_name
geometry_msgs/TransformStamped[] fixed_frame_transforms
moveit_msgs/AllowedCollisionMatrix allowed_collision_matrix
moveit_msgs/LinkPadding[] link_padding
moveit_msgs/LinkScale[] link_scale
moveit_msgs/ObjectColor[] object_colors
moveit_msgs/PlanningSceneWorld world
bool is_diff""",
}


def fields_of(name):
    return DEFINITIONS[name].strip()


def needed_by(name, found):
    """Appends the types that `name` is made of, itself first."""
    if name in found:
        return found
    found.append(name)
    for line in fields_of(name).splitlines():
        kind = line.split()[0].split('[')[0]
        if '/' in kind:
            needed_by(kind, found)
    return found


def full_definition(name):
    """The text that a publisher's connection header carries: the fields of all types it is made of."""
    parts = [fields_of(name)]
    for each in needed_by(name, [])[1:]:
        parts.append('=' * 80 + '\nMSG: ' + each + '\n' + fields_of(each))
    return '\n'.join(parts) + '\n'


def message_classes(name):
    """Message classes by name: that of `name` and those that it is made of."""
    return generate_dynamic(name, full_definition(name))
