//! Imitations of other methods' spectra: how near spectrum matching comes to its models.

use bn_cli::Outcome;

use super::chapter::{Chapter, Value};
use super::{Effort, SEED};
use crate::measure::imitation::{BINS, Curves, FARTHEST, HIGHEST, Imitation, MODELS};

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let (n, sets) = if effort.quick { (64, 2) } else { (1024, 10) };
    let mut rows = Vec::new();
    for model in MODELS {
        let imitation = Imitation::of(model, n, sets, SEED)?;
        let wanted = Curves::of(&imitation.model)?;
        let Imitation { itself, spectral, force, .. } = &imitation;
        for (who, made) in [("spectral", spectral), ("force", force), ("itself", itself)] {
            let [power, rdf] = Curves::of(made)?.differences(&wanted);
            rows.push(vec![model.into(), who.into(), Value::Real(power), Value::Real(rdf)]);
        }
    }
    Ok(Chapter {
        id: "imitations",
        title: "Imitations of other methods",
        method: format!(
            "{sets} sets of {n} points by each model, as many that imitate them, and as many other \
             sets of the model itself. Root mean square of the differences of the means over the sets: \
             of the radial power by rings of one cycle up to {HIGHEST} sqrt(n), weighted by their \
             modes, and of the RDF in bins of 1/({BINS} sqrt(n)) up to {FARTHEST}/sqrt(n). \
             `spectral` is given the models' radial power, `force` their RDF in n bins."
        ),
        columns: &["model", "imitated by", "rms of P", "rms of g"],
        rows,
        diagrams: Vec::new(),
    })
}
