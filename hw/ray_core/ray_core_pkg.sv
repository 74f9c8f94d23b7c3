// Shared by the parts of the ray core: the lines of its memory, rays, results.
//
// Memory is read in lines of 64 bytes, by number: line n is at byte 64 n. Bit 0 is the lowest bit of the first byte.
package ray_core_pkg;

  // verilator lint_off UNUSEDPARAM
  // No top module uses everything.

  localparam int unsigned LineWidth = 512;
  localparam int unsigned AddressWidth = 28;  // width of a line's number: 16 GiB of memory

  // ---- Node line: up to seven children and their boxes
  //
  // A box is given on the node's own grid: along axis k, q (0 to 255) is the coordinate origin_k + q 2**(e_k - 127),
  // exactly. A box contains all of its child's triangles, which may touch its faces. The children's lines are
  // consecutive from line `base`, child 0 first: one line for an inner node, or one line for each triangle of a leaf.

  localparam int unsigned Children = 7;
  localparam int unsigned NodeOrigin = 0;  // three binary32, finite
  localparam int unsigned NodeExponents = 96;  // three e_k of eight bits, 1 to 254
  localparam int unsigned NodeBase = 120;  // AddressWidth bits
  localparam int unsigned NodeKinds = 148;  // four bits per child, see below
  localparam int unsigned NodeBoxes = 176;  // 48 bits per child: low x, y, z, high x, y, z
  localparam int unsigned KindWidth = 4;
  localparam int unsigned BoxWidth = 48;
  localparam logic [KindWidth-1:0] KindAbsent = 4'd0;  // 1 to 7: a leaf of that many triangles
  localparam logic [KindWidth-1:0] KindInner = 4'd8;
  localparam int unsigned MaxLevels = 48;  // maximum number of nodes from the root to a leaf

  // ---- Triangle line

  localparam int unsigned TriangleCorners = 0;  // nine binary32: A.x, A.y, A.z, B.x, ... C.z
  localparam int unsigned TriangleIndex = 288;  // 32 bits: the id; with Exact, this line's number
  localparam int unsigned TriangleRank = 320;  // 32 bits; with Exact, the lowest wins at equal t

  localparam int unsigned TriangleWidth = 320;  // used bits of the line, without the rank
  localparam int unsigned RankWidth = 32;

  // ---- box_unit's result for a node: a group of children
  //
  // Children that the ray enters, near first: entry 0 is the nearest. `enter` of an entry is a lower bound of the t
  // where the ray enters the box: the upper bits of a binary32 number without its sign, all ones if t overflows.

  localparam int unsigned EnterWidth = 19;
  localparam int unsigned OffsetWidth = 6;  // child's first line less `base`: below 7 * 7
  localparam int unsigned LeafWidth = 3;  // number of a leaf's triangles; 0: an inner node
  // {enter, offset, count}
  localparam int unsigned ChildWidth = EnterWidth + OffsetWidth + LeafWidth;
  localparam int unsigned GroupWidth = AddressWidth + Children * ChildWidth;

  typedef struct packed {
    logic [AddressWidth-1:0]        base;
    logic [Children*ChildWidth-1:0] entries;
  } group_t;

  // Returns whether a child's box surely begins beyond t_max (binary32 without sign). Such words compare as integers.
  function automatic logic is_beyond(logic [EnterWidth-1:0] enter, logic [30:0] t_max);
    is_beyond = t_max < {enter, {31 - EnterWidth{1'b0}}};
  endfunction

  // Clocks from the edge that takes a node to the edge after which its group is at the output, see box_unit.
  localparam int unsigned BoxLatency = 21;

  // ---- Numbers inside box_unit, in units of 2**(E - UnitBits), where 2**E is above all t in the node (see box_unit)

  localparam int unsigned UnitBits = 22;
  localparam int unsigned StepWidth = 33;  // width of s, up to 2**32, in 256ths of a unit
  localparam int unsigned PlaneWidth = 36;  // width of planes, two's complement

  typedef struct packed {  // values of a ray in a node; words and bits by axis, x lowest
    logic [8:0]  exponent;   // the exponent E, with binary32's bias
    logic [95:0] inverse;    // 1 / I_k with its sign, limited to the cap 2**(E + 2 - (e_k - 127))
    logic [32:0] caps;       // the exponents of the caps, 11 signed bits each
    logic [2:0]  is_capped;  // the inverse is the cap
    logic [2:0]  is_open;    // binary32 cannot represent the cap: the axis is ignored
  } scale_t;

  // ---- A ray, as the user gives it

  localparam logic [30:0] Infinity = 31'h7f80_0000;  // as t_max: no limit

  typedef struct packed {
    logic [95:0]             origin;     // binary32, x lowest
    logic [95:0]             direction;
    logic [30:0]             t_max;
    logic [31:0]             skip_id;
    logic [31:0]             source_id;
    logic                    any_hit;
    logic [31:0]             tag;
  } ray_t;

  // ---- Results of a ray

  typedef enum logic {
    ResultEnd   = 1'd0,  // the ray's last result: the nearest sure hit, if there is one
    ResultDoubt = 1'd1   // a triangle that may be the nearest hit: exact arithmetic must decide
  } result_e;

  localparam int unsigned TestsWidth = AddressWidth;  // a ray tests a triangle line once at most

  // The reason why a ray's hits are invalid
  typedef enum logic [2:0] {
    ErrorNone      = 3'd0,
    ErrorMemory    = 3'd1,  // one of the ray's lines came with an error
    ErrorCycle     = 3'd2,  // the ray is in a cycle of nodes, or in too deep a tree: see traversal
    ErrorDirection = 3'd3,  // the ray's direction is not scaled
    ErrorAbort     = 3'd4   // the user aborted the ray
  } error_e;

  // Returns whether the largest component of a direction is in [1, 2).
  function automatic logic is_scaled(logic [95:0] direction);
    is_scaled = (direction[30:23] == 8'd127) || (direction[62:55] == 8'd127)
             || (direction[94:87] == 8'd127);
    for (int unsigned k = 0; k < 3; k++) begin
      if (direction[32*k+23+:8] > 8'd127) is_scaled = 1'b0;
    end
  endfunction

  localparam int unsigned TErrorWidth = set_up_pkg::TErrorExponentWidth;
  localparam logic [TErrorWidth-1:0] NoT = '1;  // t_error of a hit whose t and P are not known

  typedef struct packed {
    logic                    kind;      // result_e
    logic [31:0]             tag;
    logic                    found;     // a sure hit exists; it and the next fields: for ResultEnd
    logic [31:0]             triangle;  // for ResultDoubt: the triangle in doubt
    logic [31:0]             t;
    logic [TErrorWidth-1:0]  t_error;   // log2 of a bound of t's error, see set_up_pkg; or NoT
    logic [95:0]             point;
    logic [TestsWidth-1:0]   tests;
    logic [2:0]              error;     // ResultEnd: error_e
  } result_t;

  // Returns the bits of a read's id: {1 for a triangle's line, entry of its cache}.
  function automatic int unsigned read_id_width(int unsigned node_lines,
                                                int unsigned triangle_lines);
    read_id_width = 1 + $clog2((node_lines > triangle_lines) ? node_lines : triangle_lines);
  endfunction

  // ---- Links between the parts of the core; the number of a ray's context comes with each

  typedef struct packed {  // a request for a line
    logic                    valid;
    logic [AddressWidth-1:0] line;
  } request_t;

  typedef struct packed {  // a request for a triangle's line
    logic                    valid;
    logic                    exact;  // 1: for exact_resolver; 0: for a test
    logic [AddressWidth-1:0] line;
  } triangle_request_t;

  typedef struct packed {  // a node's line for a ray
    logic                 valid;
    logic                 error;
    logic [LineWidth-1:0] line;
  } node_line_t;

  typedef struct packed {  // a triangle's line for a ray
    logic                     valid;
    logic                     exact;  // as in triangle_request_t
    logic                     error;
    logic [RankWidth-1:0]     rank;
    logic [TriangleWidth-1:0] line;
  } triangle_line_t;

  typedef struct packed {  // which children of a node a ray enters
    logic                valid;
    group_t              group;
    logic [Children-1:0] inner;  // entries that are inner nodes
    logic [Children-1:0] leaf;   // entries that are leaves
  } boxes_t;

  // The result of a test: a doubt, a sure hit (found) or a miss
  typedef struct packed {
    logic                                   valid;
    logic                                   is_skipped;  // the ray ignores the triangle
    logic                                   doubt;
    logic                                   found;
    logic [31:0]                            triangle;
    logic [31:0]                            t;
    logic [hit_test_pkg::TErrorWidth-1:0]   t_error;  // without the plane's errors, see set_up_pkg
    logic [set_up_pkg::PlaneErrorWidth-1:0] normal_error;
    logic [set_up_pkg::PlaneErrorWidth-1:0] distance_error;
    logic [95:0]                            point;
  } verdict_t;

  typedef struct packed {  // a ray's nearest hit so far
    logic                   found;
    logic [31:0]            triangle;
    logic [31:0]            t;
    logic [TErrorWidth-1:0] t_error;
    logic [TestsWidth-1:0]  tests;  // number of the ray's tests
  } hit_t;

  typedef struct packed {  // what is known of a ray when it ends
    logic [31:0] tag;
    hit_t        hit;
    logic [2:0]  error;
  } end_t;

  typedef struct packed {
    logic        valid;
    logic [31:0] tag;
    logic [31:0] triangle;
  } doubt_t;

  typedef struct packed {  // a doubt that closest_hit passes to exact_resolver
    logic                    valid;
    logic                    is_hit;  // 1: certainly a hit; 0: the ray may miss it
    logic [AddressWidth-1:0] line;
  } open_t;

  typedef struct packed {  // what closest_hit tells exact_resolver of a ray
    logic                    ended;  // the ray needs no further hit
    logic                    found;  // there is a sure hit, on the triangle of `line`
    logic [AddressWidth-1:0] line;
    logic [30:0]             t_max;  // if found is 0, the user's t_max
  } known_t;

  // ---- Events of a clock, for counters

  typedef enum logic [3:0] {
    EventRay      = 4'd0,  // a ray has ended
    EventNode     = 4'd1,  // box_unit takes a node
    EventTriangle = 4'd2,  // triangle_test takes a triangle
    EventHit      = 4'd3,  // a test ends with a sure hit
    EventMiss     = 4'd4,  // a test ends with a sure miss, or on a triangle that the ray ignores
    EventDoubt    = 4'd5,  // a test ends with a doubt
    EventNearTie  = 4'd6,  // a sure hit becomes a doubt, as another hit may be as near
    EventOverflow = 4'd7,  // a ray whose own stack is full takes the shared groups
    EventRead     = 4'd8,  // a line is requested from memory
    EventWait     = 4'd9,  // memory does not take a read
    EventExact    = 4'd10  // exact_unit has a question
  } event_e;

  localparam int unsigned NumEvents = 11;

  // verilator lint_on UNUSEDPARAM

endpackage
