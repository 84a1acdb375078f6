//! The results row: everything one run of one case says, as one JSON object.
//!
//! Units are in the names: `_ms` milliseconds, `_bytes`, `_px` pixels, `_mhz`; shares are 0 to 1.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::clock::Clock;
use super::comparison::Ratio;
use super::engine::{Fallback, RecordMode};
use crate::gpu::DeviceInfo;
use crate::measure::statistics::Spread;
use crate::measure::{Accuracy, Stability};
use crate::methods::{Case, Kind, MethodInfo};
use crate::scene::Scene;

/// Raised when a field changes its name or meaning.
pub const SCHEMA_VERSION: u32 = 2;

/// The commit the program was built from.
pub const COMMIT: &str = env!("MIRRORBENCH_COMMIT");

/// One run of one case on one scene at one size over one list of frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Row {
    pub schema_version: u32,
    /// Hash of all inputs: equal for runs that should agree.
    pub run: String,
    pub commit: String,
    pub scene: SceneCard,
    /// Canonical text of the case.
    pub case: String,
    /// The method; those of a hybrid are joined by `;` in the order of its parts.
    pub method: String,
    /// The variant, joined like `method`.
    pub variant: String,
    /// Every parameter; those of a hybrid are called `PATTERN/key`.
    pub params: Map<String, Value>,
    /// What filled pixels that were missing or flagged: none, environment or ray.
    pub fallback: String,
    /// What timed frames wrote: radiance or full. Accuracy is always measured with full.
    pub record: String,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// The scene's frames that were drawn, in order.
    pub frames: Vec<u32>,
    /// Those of them that were compared with the truth.
    pub truth_frames: Vec<u32>,
    pub device: DeviceCard,
    /// The times are a processor's, not a GPU's: compare counters and slopes, not milliseconds.
    pub software_timing: bool,
    /// Pixels a reflector covers: mean over the frames compared, or else those of the middle frame
    /// timed. Null where neither was.
    pub reflector_pixels: Option<f64>,
    /// Null where nothing was timed.
    pub prepare: Option<Prepare>,
    /// Null where nothing was timed.
    pub frame_gpu_ms: Option<FrameTime>,
    /// Null for the first case of a table, and where too few rounds were timed.
    pub ratio: Option<Ratio>,
    pub passes: Vec<PassRow>,
    /// Device-independent work a frame, named by the method; mean over the frames compared.
    pub counters: BTreeMap<String, f64>,
    /// Null where nothing was compared.
    pub accuracy: Option<Accuracy>,
    /// Null where no path was followed.
    pub stability: Option<Stability>,
    pub clock: Option<Clock>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneCard {
    pub name: String,
    pub hash: String,
    /// Of all objects, instances counted once each.
    pub triangles: u64,
    pub vertices: u64,
    /// Names in the order of the ids that images of objects hold.
    pub objects: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeviceCard {
    pub name: String,
    pub driver: String,
    pub api: String,
    pub is_software: bool,
}

/// Cost of building what does not depend on the current eye.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prepare {
    /// Frames of the timed list before which it ran.
    pub calls: u64,
    /// Median a call.
    pub gpu_ms: f64,
    /// Median a call.
    pub cpu_ms: f64,
    /// Largest device memory held.
    pub bytes: u64,
}

/// GPU time of a frame, prepare not included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrameTime {
    pub median: f64,
    pub min: f64,
    pub p95: f64,
    /// Frames measured after warm-up.
    pub n: u64,
    /// 95 % bootstrap interval of the median, drawn in runs of bursts.
    pub ci95: [f64; 2],
    /// Median with the prepare passes of each frame included.
    pub with_prepare: f64,
}

/// One pass over all timed frames that ran it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PassRow {
    pub name: String,
    /// Whether it belongs to prepare, outside the frame's time.
    pub prepare: bool,
    pub gpu_ms: Spread,
    /// Median of a processor scope; 0 for a GPU pass.
    pub cpu_ms: f64,
    /// Shader invocations, median; 0 where not counted.
    pub invocations: u64,
}

impl Row {
    /// The JSON Schema of a row, as committed in `paper-figures/results.schema.json`.
    pub fn schema() -> Value {
        schemars::schema_for!(Row).to_value()
    }
}

impl SceneCard {
    pub fn of(scene: &Scene) -> Self {
        SceneCard {
            name: scene.name.clone(),
            hash: scene.hash.clone(),
            triangles: scene.triangles() as u64,
            vertices: scene.vertices() as u64,
            objects: scene.objects.iter().map(|object| object.name.clone()).collect(),
        }
    }
}

impl From<&DeviceInfo> for DeviceCard {
    fn from(info: &DeviceInfo) -> Self {
        let DeviceInfo { name, driver, api, is_software, .. } = info.clone();
        DeviceCard { name, driver, api, is_software }
    }
}

/// The columns that describe a case: method, variant and params.
pub fn case_columns(
    case: &Case,
    methods: &[&'static MethodInfo],
) -> (String, String, Map<String, Value>) {
    let joined = |names: Vec<&str>| names.join(";");
    let method = joined(case.parts.iter().map(|part| part.method).collect());
    let variant = joined(case.parts.iter().map(|part| part.variant).collect());
    let mut params = Map::new();
    for part in &case.parts {
        let table = methods.iter().find(|info| info.id == part.method).map(|info| info.params);
        for (key, text) in &part.values.0 {
            let kind = table.and_then(|t| t.iter().find(|p| p.name == *key)).map(|p| p.kind);
            params.insert(case.column(part, key), typed(kind, text));
        }
    }
    (method, variant, params)
}

/// Numbers as numbers, everything else as text.
fn typed(kind: Option<Kind>, text: &str) -> Value {
    let number = match kind {
        Some(Kind::Integer { .. } | Kind::IntegerOrAuto { .. }) => {
            text.parse::<i64>().ok().map(Value::from)
        }
        Some(Kind::Real { .. }) => text.parse::<f64>().ok().map(Value::from),
        _ => None,
    };
    number.unwrap_or_else(|| Value::from(text))
}

impl Fallback {
    pub const NAMES: [(&'static str, Fallback); 3] =
        [("none", Fallback::None), ("environment", Fallback::Environment), ("ray", Fallback::Ray)];

    pub fn name(self) -> &'static str {
        match self {
            Fallback::None => "none",
            Fallback::Environment => "environment",
            Fallback::Ray => "ray",
        }
    }
}

impl RecordMode {
    pub const NAMES: [(&'static str, RecordMode); 2] =
        [("radiance", RecordMode::Radiance), ("full", RecordMode::Full)];

    pub fn name(self) -> &'static str {
        match self {
            RecordMode::Radiance => "radiance",
            RecordMode::Full => "full",
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::measure::Jitter;
    use crate::measure::ratio::Comparison;
    use crate::methods::{Selected, Values};

    /// A row in which every optional part is there.
    pub fn row(run: &str) -> Row {
        let spread = Spread { median: 2.0, min: 1.5, p95: 3.25 };
        Row {
            schema_version: SCHEMA_VERSION,
            run: run.into(),
            commit: COMMIT.into(),
            scene: SceneCard {
                name: "columns".into(),
                hash: "00ff".into(),
                triangles: 12,
                vertices: 24,
                objects: vec!["ball".into(), "floor".into()],
            },
            case: "environment-map".into(),
            method: "environment-map".into(),
            variant: "published".into(),
            params: Map::from_iter([("size".to_owned(), Value::from(256))]),
            fallback: Fallback::None.name().into(),
            record: RecordMode::Radiance.name().into(),
            size: [1280, 720],
            frames: vec![0, 1, 2],
            truth_frames: vec![1],
            device: DeviceCard {
                name: "llvmpipe".into(),
                driver: "lavapipe".into(),
                api: "1.3.230".into(),
                is_software: true,
            },
            software_timing: true,
            reflector_pixels: Some(1000.0),
            prepare: Some(Prepare { calls: 1, gpu_ms: 4.0, cpu_ms: 0.5, bytes: 1 << 20 }),
            frame_gpu_ms: Some(FrameTime {
                median: 2.0,
                min: 1.5,
                p95: 3.25,
                n: 30,
                ci95: [1.9, 2.1],
                with_prepare: 6.0,
            }),
            ratio: Some(Ratio {
                baseline: "none".into(),
                rounds: 30,
                frame: Comparison::new(2.0, [1.9, 2.1]),
                with_prepare: Comparison::new(6.0, [5.7, 6.3]),
            }),
            passes: vec![PassRow {
                name: "environment-map/reflect".into(),
                prepare: false,
                gpu_ms: spread,
                cpu_ms: 0.0,
                invocations: 1000,
            }],
            counters: BTreeMap::from([("rays".to_owned(), 1000.0)]),
            accuracy: None,
            stability: Some(Stability {
                frames: [0, 2],
                jitter_px: Some(Jitter { median: 0.1, p95: 0.2 }),
                pops: 0,
                temporal_error: None,
                points: 900.0,
                covered: 0.9,
                speed_px: 2.0,
            }),
            clock: Some(Clock {
                before_mhz: Some(3000.0),
                after_mhz: None,
                throttled: 0,
                load: Some(0.5),
                load_after: Some(1.5),
                steady: true,
            }),
        }
    }

    #[test]
    fn the_row_has_the_fields_of_the_design() {
        let value = serde_json::to_value(row("a")).unwrap();
        let keys: Vec<&str> = value.as_object().unwrap().keys().map(String::as_str).collect();
        for key in [
            "schema_version",
            "run",
            "commit",
            "scene",
            "case",
            "method",
            "variant",
            "params",
            "fallback",
            "size",
            "frames",
            "device",
            "reflector_pixels",
            "prepare",
            "frame_gpu_ms",
            "ratio",
            "passes",
            "counters",
            "accuracy",
            "stability",
            "clock",
        ] {
            assert!(keys.contains(&key), "{key} is missing");
        }
        let frame_keys = value["frame_gpu_ms"].as_object().unwrap().keys();
        assert!(frame_keys.eq(["median", "min", "p95", "n", "ci95", "with_prepare"]));
    }

    #[test]
    fn params_keep_their_kind_and_a_hybrid_names_its_parts() {
        let part = |reflectors: &str| Selected {
            reflectors: reflectors.into(),
            method: "m",
            variant: "published",
            values: Values(vec![
                ("steps", "3".into()),
                ("size", "auto".into()),
                ("tau", "2".into()),
            ]),
        };
        static METHOD: MethodInfo = crate::methods::MethodInfo {
            id: "m",
            title: "",
            paper: "",
            family: crate::methods::Family::Baseline,
            depends: crate::methods::Changes { objects: false, reflectors: false, shading: false },
            flags: false,
            refracts: false,
            variants: &["published"],
            params: &[
                param("steps", Kind::Integer { min: 0, max: 9 }),
                param("size", Kind::IntegerOrAuto { min: 0, max: 9 }),
                param("tau", Kind::Real { min: 0.0, max: 9.0 }),
            ],
            limits: "",
            passes: &[],
            counters: &[],
            new: None,
        };
        const fn param(name: &'static str, kind: Kind) -> crate::methods::Param {
            crate::methods::Param { name, kind, defaults: &["1"], needs: None, doc: "" }
        }
        let columns = |parts| case_columns(&Case { text: String::new(), parts }, &[&METHOD]);
        let (method, _, params) = columns(vec![part("*")]);
        assert_eq!(method, "m");
        assert_eq!(Value::Object(params).to_string(), r#"{"steps":3,"size":"auto","tau":2.0}"#);
        let (method, variant, params) = columns(vec![part("ball"), part("*")]);
        assert_eq!((method.as_str(), variant.as_str()), ("m;m", "published;published"));
        assert!(params.contains_key("ball/steps") && params.contains_key("*/tau"));
    }
    /// `BLESS=1` writes the file, and fails so that nobody blesses unawares.
    #[test]
    fn the_committed_schema_is_current() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/paper-figures/results.schema.json");
        let current = format!("{:#}\n", Row::schema());
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(path, &current).unwrap();
            panic!("blessed {path}");
        }
        let committed = std::fs::read_to_string(path).unwrap_or_default();
        assert!(committed == current, "{path} is stale: run the test again with BLESS=1");
    }
}
